// SPDX-License-Identifier: GPL-3.0-or-later
// Places of the target that are thinner than powder holds together, or gaps too narrow to get
// powder out of. A rule of thumb about what is wanted: whoever judges a print does not ask here.
//
// Thick is what balls of the rule's diameter fill. Thin is what stands out of all that by more than
// half the rule, measured along paths within the target: an edge or a corner of a block, which no
// ball fills either, does not (sqrt(3) - 1 = 0.73 of a ball's radius).
//
//   target   ..........#....    thick   ...............    thin   ..........#....
//            ..........#....            ...............           ..........#....
//            .########.#....            ..######.......           ..........#....
//            .##########....            .########......           ...............
//            .########......            .########......           ...............
//
// A place's width is the diameter of the largest ball around the middle of one of its rows: of a
// wall at any angle its thickness, of a pin its diameter.
//
// Balls are laid out in cells: a voxel along x, rows along y up to a tenth of the rule
// together, a layer along z; a cell with any solid voxel is solid. So a wall at the rule is never
// named, one thinner by two cells always is, and a width may be a cell too large.
#pragma once

#include <functional>

#include "slicer/base/work.h"
#include "slicer/layers/grid.h"
#include "slicer/layers/pipeline.h"
#include "slicer/layers/regions.h"
#include "slicer/voxels/voxelize.h"

namespace binderjet {

// What is looked at: the part, or the powder around it and in it.
enum class Matter { kPart, kPowder };

struct ThinPlace {
  Region region;        // in voxels and slices of the job
  double width_mm = 0;  // its thickest
};

// The finest rule that a grid's cells can tell: three of the coarsest.
double least_rule_mm(const Grid& grid);

// Calls found(place) for each place of all layers of `target` that is thinner than `rule_mm`, at
// least least_rule_mm(). Streams: holds the layers that two balls span.
void find_thin_places(const Pipeline<VoxelLayer>& target, const Grid& grid, double rule_mm,
                      Matter matter, const Work& work,
                      const std::function<void(const ThinPlace&)>& found);

}  // namespace binderjet
