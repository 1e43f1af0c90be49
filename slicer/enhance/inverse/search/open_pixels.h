// SPDX-License-Identifier: GPL-3.0-or-later
// The pixels that a search may flip: those near the target's boundary.
#pragma once

#include "slicer/layers/grid.h"
#include "slicer/layers/run_layer.h"
#include "slicer/voxels/voxelize.h"

namespace binderjet {

// The pixels within `reach_px` (along x and y) of a pixel with solid in any slice and of one with
// powder in any slice.
RunLayer open_pixels(const VoxelLayer& target, const Grid& grid, int reach_px);

// The layer with what lies within `by` pixels, along x and y, of its pixels.
RunLayer grown(const RunLayer& layer, int by);

}  // namespace binderjet
