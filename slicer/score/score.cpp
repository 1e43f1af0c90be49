// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/score/score.h"

#include <utility>

#include "slicer/voxels/any_slice.h"

namespace binderjet {
namespace {

// Two streams of the same layers as one.
class ComparedStream : public Stream<ComparedLayer> {
 public:
  ComparedStream(std::unique_ptr<Stream<VoxelLayer>> target,
                 std::unique_ptr<Stream<RunLayer>> printed)
      : target_(std::move(target)), printed_(std::move(printed)) {}

  LayerRange rest() const override { return target_->rest(); }
  std::vector<Shared<ComparedLayer>> next(int count) override {
    const auto target = target_->next(count);
    const auto printed = printed_->next(count);
    std::vector<Shared<ComparedLayer>> out;
    for (std::size_t i = 0; i < target.size(); ++i) {
      out.push_back(std::make_shared<const ComparedLayer>(target[i], printed[i]));
    }
    return out;
  }

 private:
  std::unique_ptr<Stream<VoxelLayer>> target_;
  std::unique_ptr<Stream<RunLayer>> printed_;
};

}  // namespace

Pipeline<LayerScore> score_steps(const Pipeline<ComparedLayer>& compared, const Grid& grid) {
  return compared.then("score", LayerReach::both_sides(1),
                       [grid](int, const Window<ComparedLayer>& window) {
                         const ComparedLayer& layer = window.middle();
                         return LayerScore{layer, count_voxels(*layer.target, *layer.printed),
                                           edge_errors(*layer.target, *layer.printed, grid),
                                           find_features(window.at(-1), layer, window.at(1), grid)};
                       });
}

std::unique_ptr<Stream<LayerScore>> score_layers(std::unique_ptr<Stream<VoxelLayer>> target,
                                                 std::unique_ptr<Stream<RunLayer>> printed,
                                                 const Grid& grid, LayerRange layers) {
  std::unique_ptr<Stream<ComparedLayer>> compared =
      std::make_unique<ComparedStream>(std::move(target), std::move(printed));
  return score_steps({"compare", layers, std::move(compared)}, grid).all_layers();
}

std::string word(FeatureKind kind) {
  switch (kind) {
    case FeatureKind::kLost:
      return "lost";
    case FeatureKind::kFused:
      return "fused";
    case FeatureKind::kSpurious:
      break;
  }
  return "spurious";
}

Score::Score(const Grid& grid, int first_layer)
    : rz_(grid.detail_vx[2]),
      lost_regions_(first_layer * rz_),
      fused_regions_(first_layer * rz_),
      printed_regions_(first_layer) {}

void Score::take(FeatureKind kind, const std::vector<Region>& regions, std::vector<Feature>& out) {
  for (Region region : regions) {
    if (kind == FeatureKind::kSpurious) {
      if (region.touches) continue;
      region.low[2] *= rz_;
      region.high[2] *= rz_;
      region.voxels *= rz_;
    }
    out.push_back({kind, region});
    ++(kind == FeatureKind::kLost ? lost_ : kind == FeatureKind::kFused ? fused_ : spurious_);
  }
}

std::vector<Feature> Score::add(const LayerScore& layer) {
  voxels_ += layer.voxels;
  edges_ += layer.edges;
  std::vector<Feature> ended;
  for (const RunLayer& slice : layer.features.lost) {
    take(FeatureKind::kLost, lost_regions_.add(slice), ended);
  }
  for (const RunLayer& slice : layer.features.fused) {
    take(FeatureKind::kFused, fused_regions_.add(slice), ended);
  }
  pieces_.add(*layer.layer.target, *layer.layer.printed);
  const RunLayer wanted = any_slice(*layer.layer.target);
  take(FeatureKind::kSpurious, printed_regions_.add(*layer.layer.printed, &wanted), ended);
  return ended;
}

std::vector<Feature> Score::finish() {
  std::vector<Feature> ended;
  take(FeatureKind::kLost, lost_regions_.finish(), ended);
  take(FeatureKind::kFused, fused_regions_.finish(), ended);
  take(FeatureKind::kSpurious, printed_regions_.finish(), ended);
  separated_ = pieces_.separated();
  loose_pieces_ = pieces_.loose_pieces();
  joints_ = pieces_.joints();
  return ended;
}

}  // namespace binderjet
