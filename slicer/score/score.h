// SPDX-License-Identifier: GPL-3.0-or-later
// The whole score of a print, streamed: voxels, depth, edges and faults. A layer is kept for as
// long as those within Depths::kMaxMm need it, and until the end only what each part and piece
// holds.
#pragma once

#include <memory>
#include <vector>

#include "slicer/layers/grid.h"
#include "slicer/layers/pipeline.h"
#include "slicer/score/depth.h"
#include "slicer/score/edge_error.h"
#include "slicer/score/faults.h"
#include "slicer/score/lost_and_fused.h"
#include "slicer/score/voxel_counts.h"

namespace binderjet {

// What can be said of one layer by itself and those around it.
struct LayerScore {
  ComparedLayer layer;
  VoxelCounts voxels;
  EdgeErrors edges;
  LostAndFused missing;
  Depths depths;
};

// Each layer from those around it; beyond the ends of what is compared is powder. Layers without a
// print (null) are there for the depth of others and have no score.
Pipeline<LayerScore> score_steps(const Pipeline<ComparedLayer>& compared, const Grid& grid);
// The print begins with the first layer of `layers` and ends with its last. So does the target, or
// it goes on below and above, where only a part of a job was printed: target_around().
std::unique_ptr<Stream<LayerScore>> score_layers(std::unique_ptr<Stream<VoxelLayer>> target,
                                                 std::unique_ptr<Stream<RunLayer>> printed,
                                                 const Grid& grid, LayerRange layers);
// The layers of the target that the score of `layers` looks at, of a job of so many.
LayerRange target_around(LayerRange layers, const Grid& grid, int job_layers);

// The score of a job, or of the part of a job that was added.
struct JobScore {
  VoxelCounts voxels;
  Depths depths;
  EdgeErrors edges;
  FaultCounts faults;
  std::vector<Fault> last_faults;  // of which only the end told; counted in `faults`
};

// Adds up layers from the first to the last.
class Scorer {
 public:
  Scorer(const Grid& grid, int first_layer);

  // Returns the faults that end below this layer.
  std::vector<Fault> add(const LayerScore& layer);
  // Once, after the last layer.
  JobScore finish();

 private:
  JobScore sum_;
  FaultFinder faults_;
};

}  // namespace binderjet
