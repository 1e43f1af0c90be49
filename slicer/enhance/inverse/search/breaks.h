// SPDX-License-Identifier: GPL-3.0-or-later
// Where a print falls apart that the target holds together, as a window of a few layers shows it.
//
//   target   .##########.      one region
//   print    .####..####.      two pieces: count 1, the smaller is loose, the gap is ".."
#pragma once

#include <span>

#include "slicer/layers/run_layer.h"
#include "slicer/score/features.h"

namespace binderjet {

struct Breaks {
  // Pieces of the print beyond the first of each connected region of the target.
  int count = 0;
  // Of the middle layer: voxels of all those pieces but the largest of its region, and what a
  // bridge to them could be made of: target voxels around them that are not printed.
  RunLayer loose;
  RunLayer gap;
};

// Regions and pieces as they are within an odd number of layers, null beyond the job's ends; the
// middle one is there. What holds together only beyond the window looks broken here.
Breaks find_breaks(std::span<const ComparedLayer* const> window);

}  // namespace binderjet
