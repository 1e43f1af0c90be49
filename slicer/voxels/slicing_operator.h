// SPDX-License-Identifier: GPL-3.0-or-later
// The slicing operator (paper, 4.1): a mask pixel is 1 iff at least half of its voxels are 1.
#pragma once

#include "slicer/layers/grid.h"
#include "slicer/layers/run_layer.h"
#include "slicer/voxels/voxelize.h"

namespace binderjet {

// The mask of one layer, from its rz slices on the voxel grid.
RunLayer slicing_operator(const VoxelLayer& voxels, const Grid& grid);

}  // namespace binderjet
