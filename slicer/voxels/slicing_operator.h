// SPDX-License-Identifier: GPL-3.0-or-later
// The slicing operator (paper, 4.1): a mask pixel is 1 iff at least half of its voxels are 1.
//
// With n of the rx ry rz voxels of a pixel inside the volume: mask = 2 n >= rx ry rz. A row of
// pixels is worked on as flips: the count n changes only where some voxel row of the pixels flips.
#pragma once

#include "slicer/layers/grid.h"
#include "slicer/layers/run_layer.h"
#include "slicer/voxels/voxelize.h"

namespace binderjet {

// The mask of one layer, from its rz slices on the voxel grid.
RunLayer slicing_operator(const VoxelLayer& voxels, const Grid& grid);

}  // namespace binderjet
