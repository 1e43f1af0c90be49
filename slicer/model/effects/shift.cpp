// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/model/effects/shift.h"

#include "slicer/model/effects/assembled_model.h"

namespace binderjet {
EffectKind shift_kind() {
  return {"shift",
          {},
          {{"by_mm", 2, -5, 5}},
          [](const EffectSpec& spec, const Grid&, AssembledModel& form) {
            const std::array<double, 2> by{spec.number("by_mm", 0), spec.number("by_mm", 1)};
            form.shift([by](const Spot&) { return by; }, by);
          }};
}

}  // namespace binderjet
