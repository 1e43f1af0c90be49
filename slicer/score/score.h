// SPDX-License-Identifier: GPL-3.0-or-later
// The whole score of a print, streamed: voxels, edges and faults. A layer is kept for as long as its
// neighbors need it, and until the end only what each part and piece holds.
#pragma once

#include <memory>
#include <vector>

#include "slicer/layers/grid.h"
#include "slicer/layers/pipeline.h"
#include "slicer/score/edge_error.h"
#include "slicer/score/faults.h"
#include "slicer/score/lost_and_fused.h"
#include "slicer/score/voxel_counts.h"

namespace binderjet {

// What can be said of one layer by itself and its two neighbors.
struct LayerScore {
  ComparedLayer layer;
  VoxelCounts voxels;
  EdgeErrors edges;
  LostAndFused missing;
};

// Each layer from its neighbors; beyond the ends of what is compared is powder.
Pipeline<LayerScore> score_steps(const Pipeline<ComparedLayer>& compared, const Grid& grid);
// Both streams begin with the first layer of `layers` and end with its last; beyond is powder.
std::unique_ptr<Stream<LayerScore>> score_layers(std::unique_ptr<Stream<VoxelLayer>> target,
                                                 std::unique_ptr<Stream<RunLayer>> printed,
                                                 const Grid& grid, LayerRange layers);

// The score of a job, or of the part of a job that was added.
struct JobScore {
  VoxelCounts voxels;
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
