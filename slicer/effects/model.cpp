// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/effects/model.h"

namespace binderjet {

Reach model_reach(const std::vector<EffectSpec>& effects, const Grid& grid) {
  Reach sum;
  for (const EffectSpec& effect : effects) {
    const Reach one = find_effect_kind(effect.kind)->reach(effect, grid);
    for (std::size_t axis = 0; axis < 2; ++axis) sum.xy_vx[axis] += one.xy_vx[axis];
    sum.layers_below += one.layers_below;
    sum.layers_above += one.layers_above;
  }
  return sum;
}

}  // namespace binderjet
