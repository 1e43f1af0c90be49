// SPDX-License-Identifier: GPL-3.0-or-later
// The loose pieces of a print as a few layers show them, and where a bridge to them could be.
#pragma once

#include <span>

#include "slicer/layers/run_layer.h"
#include "slicer/score/lost_and_fused.h"

namespace binderjet {

struct LooseInWindow {
  // Pieces of the print beyond the first of each part of the target.
  int count = 0;
  // Of the middle layer: voxels of all those pieces but the one that has most of its part, and what
  // a bridge to them could be made of: target voxels around them that are not printed.
  RunLayer loose;
  RunLayer gap;
};

// Parts and pieces as they are within an odd number of layers, null beyond the job's ends; the
// middle one is there. What holds together only beyond the window looks loose here.
LooseInWindow find_loose_in_window(std::span<const ComparedLayer* const> window);

}  // namespace binderjet
