// SPDX-License-Identifier: GPL-3.0-or-later
// Masks as the target is: the slicing operator and nothing else.
#include "slicer/enhance/masks.h"
#include "slicer/voxels/slicing_operator.h"

namespace binderjet {

Pipeline<MaskLayer> plain_masks(const Pipeline<VoxelLayer>& target, const Grid& grid) {
  return target.then("slice", {}, [grid](int, const Window<VoxelLayer>& window) {
    return MaskLayer{slicing_operator(window.middle(), grid), window.shared(0), {}};
  });
}

}  // namespace binderjet
