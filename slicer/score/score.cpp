// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/score/score.h"

#include <utility>

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
  return compared.then(
      "score", LayerReach::both_sides(1), [grid](int, const Window<ComparedLayer>& window) {
        const ComparedLayer& layer = window.middle();
        return LayerScore{layer, count_voxels(*layer.target, *layer.printed),
                          edge_errors(*layer.target, *layer.printed, grid),
                          find_lost_and_fused(window.at(-1), layer, window.at(1), grid)};
      });
}

std::unique_ptr<Stream<LayerScore>> score_layers(std::unique_ptr<Stream<VoxelLayer>> target,
                                                 std::unique_ptr<Stream<RunLayer>> printed,
                                                 const Grid& grid, LayerRange layers) {
  std::unique_ptr<Stream<ComparedLayer>> compared =
      std::make_unique<ComparedStream>(std::move(target), std::move(printed));
  return score_steps({"compare", layers, std::move(compared)}, grid).all_layers();
}

Scorer::Scorer(const Grid& grid, int first_layer)
    : faults_(grid.detail_vx[2], {.first_layer = first_layer}) {}

std::vector<Fault> Scorer::add(const LayerScore& layer) {
  sum_.voxels += layer.voxels;
  sum_.edges += layer.edges;
  std::vector<Fault> ended = faults_.add(*layer.layer.target, *layer.layer.printed, layer.missing);
  for (const Fault& fault : ended) ++sum_.faults[fault.kind];
  return ended;
}

JobScore Scorer::finish() {
  sum_.last_faults = faults_.finish();
  for (const Fault& fault : sum_.last_faults) ++sum_.faults[fault.kind];
  return std::move(sum_);
}

}  // namespace binderjet
