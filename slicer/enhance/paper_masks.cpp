// SPDX-License-Identifier: GPL-3.0-or-later
// The paper's passes as steps, each over the whole part: print the masks so far, and let the rule
// move the boundary of the volume V where the print is wrong.
//
//   target = V --> slice volume --> [ print pass --> paper rule: the next V and its mask ] x passes
#include <utility>

#include "slicer/enhance/masks.h"
#include "slicer/enhance/paper/paper_rule.h"
#include "slicer/voxels/slicing_operator.h"

namespace binderjet {
namespace {

// A layer of the current volume V with its mask.
struct SlicedLayer {
  Shared<VoxelLayer> target;
  Shared<VoxelLayer> volume;
  RunLayer mask;
};

// What the printer makes of each layer, which may take the masks around it.
Pipeline<PassLayer> print_pass(const Pipeline<SlicedLayer>& sliced,
                               const std::shared_ptr<const PrinterModel>& model) {
  const int reach = model->window_reach();
  return sliced.then("print pass", LayerReach::both_sides(reach),
                     [model, reach](int layer, const Window<SlicedLayer>& window) {
                       const RunWindow masks = runs_around(
                           window, reach, [](const SlicedLayer& near) { return &near.mask; });
                       const SlicedLayer& here = window.middle();
                       return PassLayer{here.target, here.volume, model->print(masks, layer)};
                     });
}

VoxelLayer next_volume(const Window<PassLayer>& three) {
  return paper_rule(three.at(-1), three.middle(), three.at(1));
}

}  // namespace

Pipeline<MaskLayer> paper_masks(const Pipeline<VoxelLayer>& target, const Grid& grid,
                                const std::shared_ptr<const PrinterModel>& model, int passes) {
  if (passes == 0) return plain_masks(target, grid);
  const LayerReach beside = LayerReach::both_sides(1);
  Pipeline<SlicedLayer> sliced =
      target.then("slice volume", {}, [grid](int, const Window<VoxelLayer>& window) {
        return SlicedLayer{window.shared(0), window.shared(0),
                           slicing_operator(window.middle(), grid)};
      });
  for (int left = passes - 1; left > 0; --left) {
    sliced = print_pass(sliced, model)
                 .then("paper rule", beside, [grid](int, const Window<PassLayer>& three) {
                   auto next = std::make_shared<const VoxelLayer>(next_volume(three));
                   RunLayer mask = slicing_operator(*next, grid);
                   return SlicedLayer{three.middle().target, std::move(next), std::move(mask)};
                 });
  }
  // The last pass keeps no volume: nobody looks at it again.
  return print_pass(sliced, model)
      .then("last paper rule", beside, [grid](int, const Window<PassLayer>& three) {
        return MaskLayer{slicing_operator(next_volume(three), grid), three.middle().target, {}};
      });
}

}  // namespace binderjet
