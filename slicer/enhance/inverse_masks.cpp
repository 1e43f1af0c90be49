// SPDX-License-Identifier: GPL-3.0-or-later
// The inverse solver's steps, layer by layer and then block by block, as one stream.
#include <array>
#include <functional>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "slicer/enhance/inverse/inverse_solver.h"
#include "slicer/enhance/inverse/repair/mend.h"
#include "slicer/enhance/masks.h"
#include "slicer/layers/blocks.h"

namespace binderjet {
namespace {

// A step of the inverse solver; every so many layers have their turn.
struct InverseTurn {
  int every;
  int which;
  std::function<InverseLayer(const InverseSolver&, LayerWindow)> work;
};

std::vector<InverseTurn> inverse_turns(const InverseSolver& solver) {
  std::vector<InverseTurn> turns;
  const auto add_round = [&](int every, const auto& work) {
    for (int which = 0; which < every; ++which) turns.push_back({every, which, work});
  };
  const auto add_rescue = [&](int every, RescueAim aim) {
    add_round(every, [aim](const InverseSolver& by, LayerWindow layers) {
      return by.rescue(layers, aim);
    });
  };
  const auto improve = [](bool anew) {
    return [anew](const InverseSolver& by, LayerWindow layers) { return by.improve(layers, anew); };
  };
  const int stride = solver.stride();
  add_round(stride, improve(true));
  if (stride > 1 || solver.follows_density()) add_round(stride, improve(false));
  add_rescue(stride, RescueAim::features);
  // What spans two layers takes one round for each.
  add_rescue(stride, RescueAim::pieces);
  add_rescue(stride, RescueAim::pieces);
  return turns;
}

// Blocks of layers are mended while those on each side stay, then blocks that begin halfway, so
// that every fault lies well within one.
constexpr int kMendLayers = 16;
constexpr std::array<BlockForm, 2> kMendRounds{BlockForm{kMendLayers, 0},
                                               BlockForm{kMendLayers, kMendLayers / 2}};

// The layers that the first round looks at, that it mends for the second, and so on to `layers`.
std::vector<LayerRange> mend_ranges(LayerRange layers, int job_layers) {
  std::vector<LayerRange> out{layers};
  for (auto form = kMendRounds.rbegin(); form != kMendRounds.rend(); ++form) {
    const LayerRange blocks =
        grown(form->blocks_of(out.front()), 1, form->blocks_of({0, job_layers}).last);
    out.insert(out.begin(), form->layers_of(blocks, job_layers));
  }
  return out;
}

using LayerBlock = Block<PrintedLayer>;

// The middle one of three blocks, null beyond the job's ends, mended.
LayerBlock mend_block(const SearchModel& by, std::span<const Shared<LayerBlock>> three,
                      int job_layers) {
  LayerBlock layers;
  LayerRange own;
  for (const Shared<LayerBlock>& block : three) {
    const int first = static_cast<int>(layers.size());
    if (block != nullptr) layers.insert(layers.end(), block->begin(), block->end());
    if (&block == &three[1]) own = {first, static_cast<int>(layers.size())};
  }
  return mended(by, std::move(layers), own, job_layers);
}

// `layers` as mend_ranges() wants them and as much more as what is lost and fused in them needs.
std::unique_ptr<Stream<PrintedLayer>> mended_layers(
    std::unique_ptr<Stream<InverseLayer>> layers, const std::vector<LayerRange>& ranges,
    int job_layers, const std::shared_ptr<const InverseSolver>& solver) {
  using Print = Step<InverseLayer, PrintedLayer>;
  std::unique_ptr<Stream<PrintedLayer>> out = std::make_unique<Print>(
      std::move(layers), grown(ranges.front(), 1, job_layers), solver->print_reach(), job_layers,
      [solver](int, Print::Window window) { return with_print(solver->by(), window); });
  using Look = Step<PrintedLayer, PrintedLayer>;
  out = std::make_unique<Look>(
      std::move(out), ranges.front(), 1, job_layers,
      [solver](int, Look::Window window) { return with_missing(solver->by(), window); });
  for (std::size_t round = 0; round < kMendRounds.size(); ++round) {
    const BlockForm form = kMendRounds[round];
    const LayerRange wanted = ranges[round + 1];
    using Mend = Step<LayerBlock, LayerBlock>;
    out = std::make_unique<FromBlocks<PrintedLayer>>(
        std::make_unique<Mend>(
            std::make_unique<ToBlocks<PrintedLayer>>(std::move(out), form, job_layers),
            form.blocks_of(wanted), 1, form.blocks_of({0, job_layers}),
            [solver, job_layers](int, Mend::Window window) {
              return mend_block(solver->by(), window, job_layers);
            }),
        form, wanted, job_layers);
  }
  return out;
}

}  // namespace

std::unique_ptr<Stream<MaskLayer>> inverse_masks(
    const TargetFrom& target_from, LayerRange layers, int job_layers,
    const std::shared_ptr<const InverseSolver>& solver) {
  const std::vector<InverseTurn> turns = inverse_turns(*solver);
  const std::vector<LayerRange> mends = mend_ranges(layers, job_layers);
  const LayerRange settled = grown(mends.front(), 1 + solver->print_reach(), job_layers);
  const LayerRange improved_range = grown(settled, solver->print_reach(), job_layers);
  const auto range_with = [&](std::size_t turns_left) {
    return grown(improved_range, static_cast<int>(turns_left) * solver->reach(), job_layers);
  };
  using First = Step<VoxelLayer, InverseLayer>;
  std::unique_ptr<Stream<InverseLayer>> improved = std::make_unique<First>(
      target_from(range_with(turns.size())), range_with(turns.size()), 0, job_layers,
      [solver](int layer, First::Window window) { return solver->plain(layer, window[0]); });

  using Improve = Step<InverseLayer, InverseLayer>;
  for (std::size_t i = 0; i < turns.size(); ++i) {
    improved = std::make_unique<Improve>(
        std::move(improved), range_with(turns.size() - i - 1), solver->reach(), job_layers,
        [solver, turn = turns[i]](int layer, Improve::Window window) {
          return layer % turn.every == turn.which ? turn.work(*solver, window)
                                                  : *window[window.size() / 2];
        });
  }
  improved = std::make_unique<Improve>(
      std::move(improved), settled, solver->print_reach(), job_layers,
      [solver](int, Improve::Window window) { return solver->settle(window); });

  using Last = Step<PrintedLayer, MaskLayer>;
  return std::make_unique<Last>(
      mended_layers(std::move(improved), mends, job_layers, solver), layers, 0, job_layers,
      [](int, Last::Window window) {
        return MaskLayer{*window[0]->layer->mask, window[0]->layer->target};
      });
}

}  // namespace binderjet
