// SPDX-License-Identifier: GPL-3.0-or-later
// Where in a layer there is anything to decide: the tiles within reach of the target's boundary. A
// pixel whose reach is all target or all powder is right as the plain mask has it.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "slicer/enhance/rules/rect_cells.h"
#include "slicer/layers/grid.h"
#include "slicer/layers/run_layer.h"

namespace binderjet {

// Pixels per tile and axis: the dose around a tile, three times, stays in a core's own cache.
constexpr int kTilePx = 48;

// Disjoint tiles of the box's pixels, row by row, that hold every pixel with a boundary of the
// slices within `reach_vx`: a side between two voxels that differ, in a slice or from one to the
// next of `slices`. All else is the same as far as a pixel can reach.
std::vector<Rect> search_tiles(std::span<const RunLayer* const> slices, const Grid& grid,
                               std::array<int, 2> reach_vx);

}  // namespace binderjet
