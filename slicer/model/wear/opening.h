// SPDX-License-Identifier: GPL-3.0-or-later
// Morphological opening on runs: what holds no box of a given size vanishes, the rest stays.
//
//   box 2 x 2      .##...#.        .##.....
//                  .#####..   ->   .##.....     one voxel high: gone
//                  .##.....        .##.....
//
// First the lower corners of all boxes that fit (erosion), then the boxes at these corners united.
#pragma once

#include <array>

#include "slicer/layers/run_layer.h"

namespace binderjet {

// The union of all boxes of size_vx[0] x size_vx[1] voxels (each at least 1) that fit in the layer.
RunLayer opening(const RunLayer& layer, std::array<int, 2> size_vx);

}  // namespace binderjet
