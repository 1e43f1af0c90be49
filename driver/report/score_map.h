// SPDX-License-Identifier: GPL-3.0-or-later
// The score as pictures and a list: a colored slice stack, and features.json beside its images.
#pragma once

#include <string>
#include <vector>

#include "driver/job/mask_source.h"
#include "driver/report/located_faults.h"
#include "slicer/layers/grid.h"
#include "slicer/score/score.h"
#include "slicer/stack/slice_stack.h"

namespace binderjet {

// One image per layer, at the voxel grid: white powder, gray where print and target agree, red
// missing, blue extra, and darker red and blue where a feature is lost or fused. A column of a
// layer's voxels has the color of its worst.
class ScoreMap {
 public:
  ScoreMap(const std::string& folder, const MaskSource& job, const Grid& grid);

  // Threads may write different layers at once; index 0 is the job's first layer.
  void write(int index, const LayerScore& layer) const;
  // Remembers the largest of those that a layer's picture can show: lost, fused and spurious.
  void add(const std::vector<Fault>& faults);
  // Writes the list and gives the folder its name.
  void finish(const JobScore& score);

 private:
  std::array<double, 3> origin_mm_;  // of voxel 0, 0 of slice 0 on the bed
  Grid grid_;
  StackWriter stack_;
  LargestOf<Fault> found_;
};

}  // namespace binderjet
