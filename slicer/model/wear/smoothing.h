// SPDX-License-Identifier: GPL-3.0-or-later
// A stack of layers smoothed in all three directions and cut at a half, a layer at a time.
#pragma once

#include <array>
#include <vector>

#include "slicer/layers/grid.h"
#include "slicer/layers/run_layer.h"
#include "slicer/layers/window.h"

namespace binderjet {

// A normal distribution along x, y (voxels) and z (layers), as whole numbers: what is solid from a
// half on does not depend on the order of sums. Symmetric, so flat faces stay.
class Smoothing {
 public:
  Smoothing(double sigma_mm, const Grid& grid);

  std::array<int, 3> reach() const;  // voxels in x and y, layers in z
  // `window` holds reach()[2] layers on each side of the middle one; null is powder.
  RunLayer operator()(const RunWindow& window) const;

 private:
  std::array<std::vector<int>, 3> weights_;  // of offsets -reach ... reach; they sum to 1024
};

}  // namespace binderjet
