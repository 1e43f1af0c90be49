// SPDX-License-Identifier: GPL-3.0-or-later
// A print that was measured: the masks that were sent and what came out.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "slicer/layers/grid.h"
#include "slicer/layers/run_layer.h"
#include "slicer/layers/stream.h"
#include "slicer/model/effects/job_extent.h"

namespace binderjet {

struct MeasuredJob {
  std::string name;  // for messages and the report
  Grid grid;
  JobPlace place;
  int first_layer = 0;                  // the number of masks[0]
  std::vector<Shared<RunLayer>> masks;  // at the printer grid
  // Each replicate has one layer per mask, at the voxel grid in x and y, registered to the masks.
  std::vector<std::vector<Shared<RunLayer>>> prints;
  // The prints come from a scanner: they may still be a little shifted, turned and blurred.
  bool scanned = false;
  // Called many times a second during long work, from any of its threads; may throw to end it.
  std::function<void()> on_check;

  void check() const {
    if (on_check) on_check();
  }
  int layers() const { return static_cast<int>(masks.size()); }
  JobExtent extent() const { return {grid, place, first_layer, layers()}; }
};

}  // namespace binderjet
