// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/model/effects/scale_xyz.h"

#include "slicer/model/effects/assembled_model.h"

namespace binderjet {
EffectKind scale_xyz_kind() {
  return {"scale_xyz",
          {},
          {{"by", 2, -0.1, 0.1}},
          [](const EffectSpec& spec, const Grid&, AssembledModel& form) {
            const std::array<double, 2> by{spec.number("by", 0), spec.number("by", 1)};
            const std::array<double, 2> center{form.place.center_mm(0), form.place.center_mm(1)};
            form.shift(
                [by, center](const Spot& spot) -> std::array<double, 2> {
                  return {by[0] * (spot.x_mm - center[0]), by[1] * (spot.y_mm - center[1])};
                },
                {by[0] * form.place.size_mm[0] / 2, by[1] * form.place.size_mm[1] / 2});
          }};
}

}  // namespace binderjet
