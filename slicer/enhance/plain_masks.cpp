// SPDX-License-Identifier: GPL-3.0-or-later
// Masks as the target is, and masks without what is too small for the printer.
#include "slicer/enhance/masks.h"
#include "slicer/voxels/slicing_operator.h"

namespace binderjet {

Pipeline<MaskLayer> plain_masks(const Pipeline<VoxelLayer>& target, const Grid& grid) {
  return target.then("slice", {}, [grid](int, const Window<VoxelLayer>& window) {
    return MaskLayer{slicing_operator(window.middle(), grid), window.shared(0), {}};
  });
}

Pipeline<MaskLayer> obeying_masks(const Pipeline<MaskLayer>& masks, const MaskRules& rules) {
  return masks.then("mask rules", {}, [rules](int, const Window<MaskLayer>& window) {
    ObeyingMask obeying = obeying_mask(window.middle().mask, rules);
    return MaskLayer{std::move(obeying.mask), window.middle().target, obeying.changes};
  });
}

}  // namespace binderjet
