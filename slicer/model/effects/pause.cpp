// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/model/effects/pause.h"

#include <cmath>

#include "slicer/model/effects/assembled_model.h"

namespace binderjet {
EffectKind pause_kind() {
  return {"pause",
          {},
          {{"at_mm", 1, -1e-9, 1000}, {"amount", 1, -0.95, 2}},
          [](const EffectSpec& spec, const Grid&, AssembledModel& form) {
            const double at = spec.number("at_mm");
            const double amount = spec.number("amount");
            form.placed.gains.push_back(
                {[at, amount](const Spot& spot) { return spot.z_mm >= at ? amount : 0; },
                 std::abs(amount)});
          }};
}

}  // namespace binderjet
