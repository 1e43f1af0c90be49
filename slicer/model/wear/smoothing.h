// SPDX-License-Identifier: GPL-3.0-or-later
// A stack of layers smoothed in all three directions and cut at a half, a layer at a time.
//
//   out(v) = 2 * sum over (i, j, k) of X(i) Y(j) Z(k) in(v + (i, j, k)) >= 1024^3
//
// X, Y and Z are gaussians in whole weights that add up to 1024, so a sum stays within an int. The
// three directions are summed one after the other: along z while voxels are still runs, then y, x.
// This is the only wear that costs every voxel of the box, boundary or not.
#pragma once

#include <array>
#include <vector>

#include "slicer/layers/grid.h"
#include "slicer/layers/run_layer.h"
#include "slicer/layers/window.h"

namespace binderjet {

// Whole weights, so the result does not depend on the order of sums; symmetric ones, so flat faces
// stay where they are.
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
