// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/model/effects/survive.h"

#include "slicer/model/effects/assembled_model.h"

namespace binderjet {

EffectKind survive_kind() {
  constexpr double kMaxWidthMm = 10;
  return {"survive",
          {},
          {{"width_mm", 2, 0, kMaxWidthMm}},
          [](const EffectSpec& spec, const Grid& grid, AssembledModel& form) {
            form.survive_vx.push_back({pixels_for(spec.number("width_mm", 0), grid.voxel_mm(0)),
                                       pixels_for(spec.number("width_mm", 1), grid.voxel_mm(1))});
          }};
}

}  // namespace binderjet
