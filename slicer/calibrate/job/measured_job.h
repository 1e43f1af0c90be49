// SPDX-License-Identifier: GPL-3.0-or-later
// A print that was measured: the masks that were sent and what came out.
#pragma once

#include <string>
#include <vector>

#include "slicer/base/work.h"
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
  // Hears how far the work on this job is; asked many times a second whether to go on.
  Work work;

  int layers() const { return static_cast<int>(masks.size()); }
  JobExtent extent() const { return {grid, place, first_layer, layers()}; }
};

}  // namespace binderjet
