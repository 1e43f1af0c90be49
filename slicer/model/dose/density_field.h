// SPDX-License-Identifier: GPL-3.0-or-later
// The solid share of the masks in a box around a place: dense parts keep their binder wet.
//
// Pixels are counted in cells of 4 x 4, over all layers of the box. With S(i, j) the sum of all
// cells below and left of corner (i, j), any box takes four reads:
//
//   solid in [a, b) x [c, d) = S(b, d) - S(a, d) - S(b, c) + S(a, c)
#pragma once

#include <cstdint>
#include <vector>

#include "slicer/layers/grid.h"
#include "slicer/layers/window.h"

namespace binderjet {

// The field of one layer. Cells keep its memory small beside the layer's own; between the middles
// of cells the share is interpolated.
class DensityField {
 public:
  static constexpr int kCellPx = 4;

  // `window` holds the masks of all layers that count, each the same; null is powder. `radius_mm`
  // is half the box's width in x and y.
  DensityField(const RunWindow& window, const Grid& grid, double radius_mm);

  // At a place in voxels from the masks' lower corner; 0 to 1.
  double at(double x_vx, double y_vx) const;

 private:
  double cell(int i, int j) const;

  std::array<int, 2> cells_{};
  std::array<double, 2> cell_vx_{};
  std::vector<float> share_;
};

}  // namespace binderjet
