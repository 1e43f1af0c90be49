// SPDX-License-Identifier: GPL-3.0-or-later
// The spurious print of one layer, as voxels that a mask can be searched without.
#pragma once

#include "slicer/layers/run_layer.h"
#include "slicer/voxels/voxelize.h"

namespace binderjet {

// The printed voxels outside the target in the boxes of the layer's spurious faults, as the layer
// shows them by itself: what a layer beside it holds to a part is spurious here, too.
RunLayer spurious_print(const VoxelLayer& target, const RunLayer& printed);

}  // namespace binderjet
