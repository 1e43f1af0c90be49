// SPDX-License-Identifier: GPL-3.0-or-later
// The spurious print of one layer, as voxels that a mask can be searched without.
#pragma once

#include "slicer/layers/run_layer.h"
#include "slicer/voxels/voxelize.h"

namespace binderjet {

// The printed voxels outside the target in the bounding box of each region of the print that holds
// no voxel of any slice of the target. Regions are connected by sides within the layer, so what a
// layer beside this one holds to a part is spurious here, too. Whole boxes are taken: a little of a
// good neighbor within the box may be among them.
RunLayer spurious_print(const VoxelLayer& target, const RunLayer& printed);

}  // namespace binderjet
