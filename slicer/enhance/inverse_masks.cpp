// SPDX-License-Identifier: GPL-3.0-or-later
// The inverse solver's work as steps of a pipeline: layer by layer, then block by block.
#include <array>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "slicer/enhance/inverse/inverse_solver.h"
#include "slicer/enhance/inverse/repair/mend.h"
#include "slicer/enhance/masks.h"

namespace binderjet {
namespace {

// One turn of the solver: every so many layers are worked on, the others pass.
struct InverseTurn {
  std::string name;
  int every;
  int which;
  std::function<InverseLayer(const InverseSolver&, LayerWindow)> work;
};

std::vector<InverseTurn> inverse_turns(const InverseSolver& solver) {
  std::vector<InverseTurn> turns;
  const auto add_round = [&](const std::string& name, const auto& work) {
    for (int which = 0; which < solver.stride(); ++which) {
      turns.push_back({name, solver.stride(), which, work});
    }
  };
  const auto rescue = [](RescueAim aim) {
    return [aim](const InverseSolver& by, LayerWindow layers) { return by.rescue(layers, aim); };
  };
  const auto improve = [](bool from_scratch) {
    return [from_scratch](const InverseSolver& by, LayerWindow layers) {
      return by.improve(layers, from_scratch);
    };
  };
  add_round("improve", improve(true));
  if (solver.stride() > 1 || solver.follows_density()) add_round("improve again", improve(false));
  add_round("rescue features", rescue(RescueAim::features));
  // What spans two layers takes one round for each.
  add_round("rescue pieces", rescue(RescueAim::pieces));
  add_round("rescue pieces", rescue(RescueAim::pieces));
  return turns;
}

// Mending goes over the job twice, in blocks of 16 layers that begin at different places:
//
//   round 1    |0 ......... 15|16 ........ 31|
//   round 2  ...... 7|8 ......... 23|24 ......     a fault across a border lies inside a block here
//
// While a block is mended the blocks beside it stay as they are, so blocks are mended side by side.
constexpr int kMendLayers = 16;
constexpr std::array<BlockForm, 2> kMendRounds{BlockForm{kMendLayers, 0},
                                               BlockForm{kMendLayers, kMendLayers / 2}};

using LayerBlock = Block<PrintedLayer>;

// The middle one of three blocks, mended.
LayerBlock mend_block(const SearchModel& by, const Window<LayerBlock>& three, int job_layers) {
  LayerBlock layers;
  LayerRange own;
  for (const int offset : {-1, 0, 1}) {
    const int first = static_cast<int>(layers.size());
    const LayerBlock* block = three.at(offset);
    if (block != nullptr) layers.insert(layers.end(), block->begin(), block->end());
    if (offset == 0) own = {first, static_cast<int>(layers.size())};
  }
  return mended(by, std::move(layers), own, job_layers);
}

Pipeline<InverseLayer> searched(const Pipeline<VoxelLayer>& target,
                                const std::shared_ptr<const InverseSolver>& solver) {
  Pipeline<InverseLayer> layers =
      target.then("begin plain", {}, [solver](int layer, const Window<VoxelLayer>& window) {
        return solver->plain(layer, window.shared(0));
      });
  for (const InverseTurn& turn : inverse_turns(*solver)) {
    layers = layers.then(turn.name, LayerReach::both_sides(solver->reach()),
                         [solver, turn](int layer, const LayerWindow& window) {
                           return layer % turn.every == turn.which ? turn.work(*solver, window)
                                                                   : window.middle();
                         });
  }
  return layers.then("settle", LayerReach::both_sides(solver->print_reach()),
                     [solver](int, const LayerWindow& window) { return solver->settle(window); });
}

Pipeline<PrintedLayer> mended_layers(const Pipeline<InverseLayer>& settled,
                                     const std::shared_ptr<const InverseSolver>& solver) {
  Pipeline<PrintedLayer> layers =
      settled
          .then(
              "print settled", LayerReach::both_sides(solver->print_reach()),
              [solver](int, const LayerWindow& window) { return with_print(solver->by(), window); })
          .then("find lost and fused", LayerReach::both_sides(1),
                [solver](int, const Window<PrintedLayer>& window) {
                  return with_missing(solver->by(), window);
                });
  for (const BlockForm& form : kMendRounds) {
    layers = layers.then_in_blocks(
        "mend", form, LayerReach::both_sides(1),
        [solver, job_layers = settled.job().last](int, const Window<LayerBlock>& window) {
          return mend_block(solver->by(), window, job_layers);
        });
  }
  return layers;
}

}  // namespace

Pipeline<MaskLayer> inverse_masks(const Pipeline<VoxelLayer>& target,
                                  const std::shared_ptr<const InverseSolver>& solver) {
  return mended_layers(searched(target, solver), solver)
      .then("take mended mask", {}, [](int, const Window<PrintedLayer>& window) {
        const InverseLayer& layer = *window.middle().layer;
        return MaskLayer{*layer.mask, layer.target, {}};
      });
}

}  // namespace binderjet
