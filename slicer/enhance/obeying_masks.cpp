// SPDX-License-Identifier: GPL-3.0-or-later
// The last step of every way of making masks: what is too small for the printer goes.
#include <utility>

#include "slicer/enhance/masks.h"

namespace binderjet {

Pipeline<MaskLayer> obeying_masks(const Pipeline<MaskLayer>& masks, const MaskRules& rules) {
  return masks.then("mask rules", {}, [rules](int, const Window<MaskLayer>& window) {
    ObeyingMask obeying = obeying_mask(window.middle().mask, rules);
    return MaskLayer{std::move(obeying.mask), window.middle().target, obeying.changes};
  });
}

}  // namespace binderjet
