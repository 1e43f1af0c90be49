// SPDX-License-Identifier: GPL-3.0-or-later
// The inverse solver's work as steps of a pipeline.
#include <functional>
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
  using Step = std::function<InverseLayer(const InverseSolver&, const LayerWindow&)>;
  // Every stride-th layer at once, from number `which`.
  const auto add = [&](const std::string& name, int reach, const Step& work, int stride = 1,
                       int which = 0) {
    layers = layers.then(name, LayerReach::both_sides(reach),
                         [solver, work, stride, which](int layer, const LayerWindow& window) {
                           return layer % stride == which ? work(*solver, window) : window.middle();
                         });
  };
  const auto memo = std::make_shared<SectionMemo>();
  const Step improve = [memo](const InverseSolver& by, const LayerWindow& window) {
    if (!by.sees_the_section_alone()) return by.improve(window);
    InverseLayer layer = window.middle();
    layer.mask = memo->mask_of(layer.target, [&] { return by.improve(window).mask; });
    return layer;
  };
  const int stride = solver->stride();
  const int rounds = stride > 1 || solver->follows_density() ? 2 : 1;
  for (int turn = 0; turn < rounds * stride; ++turn) {
    add("improve", solver->improve_reach(), improve, stride, turn % stride);
  }

  const auto print = [&] { add("print so far", solver->print_reach(), &InverseSolver::print); };
  const auto repair = [&](int every) {
    for (int which = 0; which < every; ++which) {
      add("repair", solver->repair_reach(), &InverseSolver::repair, every, which);
      if (stride > 1) print();  // else a layer's print is its own mask's alone
    }
  };
  print();
  add("find broken", 1, &InverseSolver::find_broken);
  // What spans two layers takes a round for each, and equal sections are mended alike; what two
  // layers then mend in opposite ways takes turns.
  repair(stride);
  repair(stride);
  repair(solver->repair_stride());
  return layers.then("take mask", {}, [](int, const LayerWindow& window) {
    return MaskLayer{*window.middle().mask, window.middle().target, {}};
  });
}

}  // namespace binderjet
