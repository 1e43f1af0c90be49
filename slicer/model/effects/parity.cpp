// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/model/effects/parity.h"

#include "slicer/model/effects/assembled_model.h"

namespace binderjet {
EffectKind parity_kind() {
  return {"parity",
          {},
          {{"by_mm", 2, -5, 5}},
          [](const EffectSpec& spec, const Grid&, AssembledModel& form) {
            const std::array<double, 2> by{spec.number("by_mm", 0), spec.number("by_mm", 1)};
            form.shift(
                [by](const Spot& spot) -> std::array<double, 2> {
                  const int sign = spot.layer % 2 == 0 ? 1 : -1;
                  return {sign * by[0], sign * by[1]};
                },
                by);
          }};
}

}  // namespace binderjet
