// SPDX-License-Identifier: GPL-3.0-or-later
// The paper's rule (its eq. 1): boundary voxels give way where too much is printed around them and
// fill where too little is (slicer/MODEL.md, The paper's rule).
#pragma once

#include "slicer/layers/run_layer.h"
#include "slicer/layers/stream.h"
#include "slicer/voxels/voxelize.h"

namespace binderjet {

// A layer on its way through the passes.
struct PassLayer {
  Shared<VoxelLayer> target;  // the first voxelization, always
  Shared<VoxelLayer> volume;  // the current volume V
  RunLayer printed;           // what the printer makes of V's mask; equal for all rz slices
};

// The next V of the middle one of three layers, simultaneous over all voxels: for each voxel of V
// with a face neighbor of the other state, s = sum of (printed - target) over the 3 x 3 x 3
// around it; s > 0 gives 0, s < 0 gives 1, s = 0 keeps it. Null neighbors are powder.
VoxelLayer paper_rule(const PassLayer* below, const PassLayer& layer, const PassLayer* above);

}  // namespace binderjet
