// SPDX-License-Identifier: GPL-3.0-or-later
// The slices of a layer united into one, for work that sees the layer as its print: one height.
#pragma once

#include "slicer/layers/run_layer.h"
#include "slicer/voxels/voxelize.h"

namespace binderjet {

// Where any slice of a layer is solid; it has at least one.
RunLayer any_slice(const VoxelLayer& layer);

}  // namespace binderjet
