// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/model/effects/layer_shift_low.h"

#include <cmath>

#include "slicer/model/effects/assembled_model.h"

namespace binderjet {
EffectKind layer_shift_low_kind() {
  return {"layer_shift_low",
          {},
          {{"by_mm", 2, -5, 5}, {"height_mm", 1, 0, 100}},
          [](const EffectSpec& spec, const Grid&, AssembledModel& form) {
            const std::array<double, 2> by{spec.number("by_mm", 0), spec.number("by_mm", 1)};
            const double height_mm = spec.number("height_mm");
            form.shift(
                [by, height_mm](const Spot& spot) -> std::array<double, 2> {
                  const double rest = std::exp(-spot.z_mm / height_mm);
                  return {by[0] * rest, by[1] * rest};
                },
                by);
          }};
}

}  // namespace binderjet
