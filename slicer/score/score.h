// SPDX-License-Identifier: GPL-3.0-or-later
// The whole score of a print, streamed: voxels, edges and features, in the memory of a few layers.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "slicer/layers/grid.h"
#include "slicer/layers/pipeline.h"
#include "slicer/layers/regions.h"
#include "slicer/score/edge_error.h"
#include "slicer/score/features.h"
#include "slicer/score/pieces.h"
#include "slicer/score/voxel_counts.h"

namespace binderjet {

// What can be said of one layer by itself and its two neighbours.
struct LayerScore {
  ComparedLayer layer;
  VoxelCounts voxels;
  EdgeErrors edges;
  LayerFeatures features;
};

// Each layer from its neighbors; beyond the ends of what is compared is powder.
Pipeline<LayerScore> score_steps(const Pipeline<ComparedLayer>& compared, const Grid& grid);
// Both streams begin with the first layer of `layers` and end with its last; beyond is powder.
std::unique_ptr<Stream<LayerScore>> score_layers(std::unique_ptr<Stream<VoxelLayer>> target,
                                                 std::unique_ptr<Stream<RunLayer>> printed,
                                                 const Grid& grid, LayerRange layers);

enum class FeatureKind { kLost, kFused, kSpurious };
std::string word(FeatureKind kind);

// A feature that the print has too few or too many of; coordinates are voxels and slices.
struct Feature {
  FeatureKind kind = FeatureKind::kLost;
  Region region;
};

// Adds up layers from the first to the last.
class Score {
 public:
  Score(const Grid& grid, int first_layer);

  // Returns the features that end below this layer.
  std::vector<Feature> add(const LayerScore& layer);
  // Returns those that reach to the end. Call it before asking for counts of features.
  std::vector<Feature> finish();

  const VoxelCounts& voxels() const { return voxels_; }
  const EdgeErrors& edges() const { return edges_; }
  std::int64_t lost() const { return lost_; }
  std::int64_t fused() const { return fused_; }
  std::int64_t spurious() const { return spurious_; }
  // Connected regions of the target that come out in several pieces.
  std::int64_t separated() const { return separated_; }
  // What comes off those, and where regions of the target print together (see PieceCounter).
  const std::vector<Region>& loose_pieces() const { return loose_pieces_; }
  const std::vector<Region>& joints() const { return joints_; }

 private:
  void take(FeatureKind kind, const std::vector<Region>& regions, std::vector<Feature>& out);

  int rz_;
  VoxelCounts voxels_;
  EdgeErrors edges_;
  RegionFinder lost_regions_;
  RegionFinder fused_regions_;
  RegionFinder printed_regions_;  // by layers: the slices of one are equal
  std::int64_t lost_ = 0;
  std::int64_t fused_ = 0;
  std::int64_t spurious_ = 0;
  PieceCounter pieces_;
  std::int64_t separated_ = 0;
  std::vector<Region> loose_pieces_;
  std::vector<Region> joints_;
};

}  // namespace binderjet
