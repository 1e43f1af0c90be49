// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/score/score.h"

#include <algorithm>
#include <utility>

namespace binderjet {
namespace {

// Two streams as one; where the target goes on below and above the print, that is null.
class ComparedStream : public Stream<ComparedLayer> {
 public:
  ComparedStream(std::unique_ptr<Stream<VoxelLayer>> target,
                 std::unique_ptr<Stream<RunLayer>> printed)
      : target_(std::move(target)), printed_(std::move(printed)) {}

  LayerRange rest() const override { return target_->rest(); }
  std::vector<Shared<ComparedLayer>> next(int count) override {
    std::vector<Shared<ComparedLayer>> out;
    const LayerRange pulled{rest().first, std::min(rest().last, rest().first + count)};
    const int shared = std::min(pulled.last, printed_->rest().last) -
                       std::max(pulled.first, printed_->rest().first);
    const int without = printed_->rest().first - pulled.first;  // below the print
    const auto target = target_->next(count);
    const auto printed = shared > 0 ? printed_->next(shared) : std::vector<Shared<RunLayer>>();
    for (int i = 0; i < pulled.size(); ++i) {
      const int print = i - std::max(0, without);
      const bool is_printed = print >= 0 && print < static_cast<int>(printed.size());
      out.push_back(std::make_shared<const ComparedLayer>(
          target[static_cast<std::size_t>(i)],
          is_printed ? printed[static_cast<std::size_t>(print)] : nullptr));
    }
    return out;
  }

 private:
  std::unique_ptr<Stream<VoxelLayer>> target_;
  std::unique_ptr<Stream<RunLayer>> printed_;
};

}  // namespace

Pipeline<LayerScore> score_steps(const Pipeline<ComparedLayer>& compared, const Grid& grid) {
  const auto depth = std::make_shared<const DepthFinder>(grid);
  return compared.then(
      "score", depth->reach(), [grid, depth](int k, const Window<ComparedLayer>& window) {
        const auto printed = [&](int offset) {
          const ComparedLayer* layer = window.at(offset);
          return layer == nullptr || layer->printed == nullptr ? nullptr : layer;
        };
        const ComparedLayer& layer = window.middle();
        LostAndFused missing = find_lost_and_fused(printed(-1), layer, printed(1), grid);
        Depths depths = depth->find(k, window, missing);
        return LayerScore{layer, count_voxels(*layer.target, *layer.printed),
                          edge_errors(*layer.target, *layer.printed, grid), std::move(missing),
                          std::move(depths)};
      });
}

std::unique_ptr<Stream<LayerScore>> score_layers(std::unique_ptr<Stream<VoxelLayer>> target,
                                                 std::unique_ptr<Stream<RunLayer>> printed,
                                                 const Grid& grid, LayerRange layers) {
  std::unique_ptr<Stream<ComparedLayer>> compared =
      std::make_unique<ComparedStream>(std::move(target), std::move(printed));
  const LayerRange all = compared->rest();
  return score_steps({"compare", all, std::move(compared)}, grid).layers(layers);
}

LayerRange target_around(LayerRange layers, const Grid& grid, int job_layers) {
  return grown(layers, DepthFinder(grid).reach(), {0, job_layers});
}

Scorer::Scorer(const Grid& grid, int first_layer)
    : faults_(grid.detail_vx[2], {.first_layer = first_layer}) {
  sum_.depths = Depths(grid);
}

std::vector<Fault> Scorer::add(const LayerScore& layer) {
  sum_.voxels += layer.voxels;
  sum_.depths += layer.depths;
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
