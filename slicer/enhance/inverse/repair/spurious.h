// SPDX-License-Identifier: GPL-3.0-or-later
// What a layer's print has that no part asked for.
#pragma once

#include "slicer/layers/run_layer.h"
#include "slicer/voxels/voxelize.h"

namespace binderjet {

// The voxels outside the target in boxes around those regions of the print (by sides, within the
// layer) that hold no voxel of any of the target's slices.
RunLayer spurious_print(const VoxelLayer& target, const RunLayer& printed);

}  // namespace binderjet
