// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/model/effects/first_layers.h"

#include <cmath>

#include "slicer/model/effects/assembled_model.h"

namespace binderjet {
EffectKind first_layers_kind() {
  return {"first_layers",
          {},
          {{"amount", 1, -0.95, 5}, {"height_mm", 1, 0, 100}},
          [](const EffectSpec& spec, const Grid&, AssembledModel& form) {
            const double amount = spec.number("amount");
            const double height = spec.number("height_mm");
            form.placed.gains.push_back({[amount, height](const Spot& spot) {
                                           return amount * std::exp(-spot.z_mm / height);
                                         },
                                         std::abs(amount)});
          }};
}

}  // namespace binderjet
