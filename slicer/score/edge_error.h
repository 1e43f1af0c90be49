// SPDX-License-Identifier: GPL-3.0-or-later
// Edge placement error: how far from each edge that is wanted the nearest printed edge is
// (slicer/MODEL.md, Scores).
#pragma once

#include <cstdint>
#include <vector>

#include "slicer/layers/grid.h"
#include "slicer/layers/run_layer.h"
#include "slicer/voxels/voxelize.h"

namespace binderjet {

// Distances of edges in mm; they add up over slices and layers. All sums are integers.
class EdgeErrors {
 public:
  // An edge without a printed one within this distance counts as this far: what is lost has no
  // place to be wrong about. Faults (slicer/score/faults.h) tell of that.
  static constexpr double kMaxMm = 2;

  EdgeErrors() : of_um_(static_cast<std::size_t>(kMaxMm * 1000) + 1, 0) {}

  void add(double distance_mm);  // 0 <= distance_mm <= kMaxMm
  EdgeErrors& operator+=(const EdgeErrors& other);

  std::int64_t edges() const { return edges_; }
  double mean_mm() const;  // 0 without edges, as the others
  double p95_mm() const;   // the least distance that 95 % of the edges do not exceed, to 1 um
  double max_mm() const { return static_cast<double>(max_nm_) * 1e-6; }

 private:
  std::vector<std::int64_t> of_um_;  // edges by distance, rounded to 1 um
  std::int64_t edges_ = 0;
  std::int64_t sum_nm_ = 0;
  std::int64_t max_nm_ = 0;
};

// One layer. An edge is the side between two voxels of a slice, one in the target and one not
// (outside the layer is powder); its error is the distance, within the slice, from its middle to
// the nearest side between a printed voxel and one that is not. Every side counts once.
EdgeErrors edge_errors(const VoxelLayer& target, const RunLayer& printed, const Grid& grid);

}  // namespace binderjet
