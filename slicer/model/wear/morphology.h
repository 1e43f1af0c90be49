// SPDX-License-Identifier: GPL-3.0-or-later
// Erosion and dilation of a stack of layers by an ellipsoid, on runs, a layer at a time.
#pragma once

#include <array>

#include "slicer/layers/grid.h"
#include "slicer/layers/run_layer.h"
#include "slicer/layers/window.h"

namespace binderjet {

// All offsets (voxels in x and y, layers in z) within `radius_mm` of the middle.
class Ellipsoid {
 public:
  Ellipsoid(double radius_mm, const Grid& grid);
  // The same within its layer only.
  static Ellipsoid disc(double radius_mm, const Grid& grid);

  // How far it reaches: voxels in x and y, layers in z.
  std::array<int, 3> reach() const { return reach_; }
  // Half its width along x at this offset; negative if there is nothing of it.
  int half_width(int dy, int dz) const;

 private:
  std::array<double, 3> radius_;
  std::array<int, 3> reach_;
};

// `window` holds reach()[2] layers on each side of the middle one; null is beyond the stack. Within
// a layer all outside is powder.
RunLayer dilated(const RunWindow& window, const Ellipsoid& by);

// What lies beyond the stack in z: powder, or more of the same.
enum class Beyond { kPowder, kSame };
RunLayer eroded(const RunWindow& window, const Ellipsoid& by, Beyond beyond);

}  // namespace binderjet
