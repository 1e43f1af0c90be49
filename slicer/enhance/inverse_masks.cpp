// SPDX-License-Identifier: GPL-3.0-or-later
// The inverse solver's work as steps of a pipeline.
#include <memory>
#include <string>

#include "slicer/enhance/inverse/inverse_solver.h"
#include "slicer/enhance/inverse/section_memo.h"
#include "slicer/enhance/masks.h"

namespace binderjet {

Pipeline<MaskLayer> inverse_masks(const Pipeline<VoxelLayer>& target,
                                  const std::shared_ptr<const InverseSolver>& solver) {
  Pipeline<InverseLayer> layers =
      target.then("begin plain", {}, [solver](int layer, const Window<VoxelLayer>& window) {
        return solver->plain(layer, window.shared(0));
      });
  const auto add_round = [&](const std::string& name, int stride, const auto& work) {
    for (int which = 0; which < stride; ++which) {
      layers =
          layers.then(name, LayerReach::both_sides(solver->reach()),
                      [solver, stride, which, work](int layer, const LayerWindow& window) {
                        return layer % stride == which ? work(*solver, window) : window.middle();
                      });
    }
  };
  const auto memo = std::make_shared<SectionMemo>();
  const auto improve = [memo](const InverseSolver& by, const LayerWindow& window) {
    if (!by.sees_the_section_alone()) return by.improve(window);
    InverseLayer layer = window.middle();
    layer.mask = memo->mask_of(layer.target, [&] { return by.improve(window).mask; });
    return layer;
  };
  const auto repair = [](const InverseSolver& by, const LayerWindow& window) {
    return by.repair(window);
  };
  add_round("improve", solver->stride(), improve);
  if (solver->stride() > 1 || solver->follows_density()) {
    add_round("improve again", solver->stride(), improve);
  }
  // What spans two layers takes a round for each; what two layers then mend in opposite ways takes
  // turns. Equal sections are mended alike in the first two.
  add_round("repair", solver->stride(), repair);
  add_round("repair", solver->stride(), repair);
  add_round("repair", solver->stride() + 1, repair);
  return layers.then("take mask", {}, [](int, const LayerWindow& window) {
    return MaskLayer{*window.middle().mask, window.middle().target, {}};
  });
}

}  // namespace binderjet
