// SPDX-License-Identifier: GPL-3.0-or-later
// Pieces of one mask put into another.
#pragma once

#include <span>
#include <vector>

#include "slicer/enhance/rules/mask_rules.h"
#include "slicer/enhance/rules/rect_cells.h"
#include "slicer/layers/grid.h"
#include "slicer/layers/run_layer.h"

namespace binderjet {

// The pixels of each run of voxels and so many on each side.
std::vector<Rect> pixels_around(const RunLayer& voxels, const Grid& grid, int around_px);

// The mask with the other one's pixels in these places; it obeys the rules.
RunLayer patched(const RunLayer& mask, const RunLayer& with, std::span<const Rect> places,
                 const MaskRules& rules);

}  // namespace binderjet
