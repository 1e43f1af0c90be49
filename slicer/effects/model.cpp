// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/effects/model.h"

#include "slicer/error.h"
#include "slicer/opening.h"

namespace binderjet {

PrinterModel::PrinterModel(const std::vector<EffectSpec>& effects, const Grid& grid)
    : repeat_{grid.detail_vx[0], grid.detail_vx[1]} {
  for (const EffectSpec& effect : effects) {
    const EffectKind* kind = find_effect_kind(effect.kind);
    kind->add(effect, grid, form_);
    const Reach one = kind->reach(effect, grid);
    for (std::size_t axis = 0; axis < 2; ++axis) reach_.xy_vx[axis] += one.xy_vx[axis];
    reach_.layers_below += one.layers_below;
    reach_.layers_above += one.layers_above;
  }
  if (form_.level <= 0) {
    throw Error(ErrorKind::kBadInput, "effects",
                "nothing binds powder: the model needs a threshold or a fill");
  }
  least_ = least_sum(form_.spread_x, form_.spread_y, form_.level);
}

RunLayer PrinterModel::print(const RunLayer& mask) const {
  RunLayer printed = box_threshold(mask, repeat_, form_.spread_x, form_.spread_y, least_);
  for (const std::array<int, 2>& box : form_.survive_vx) printed = opening(printed, box);
  return printed;
}

}  // namespace binderjet
