// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/effects/jet_out.h"

#include <cmath>

#include "slicer/effects/model.h"

namespace binderjet {
EffectKind jet_out_kind() {
  return {"jet_out",
          {},
          {{"from_mm", 1, -1000, 1000}, {"to_mm", 1, -1000, 1000}, {"amount", 1, -1, 2}},
          [](const EffectSpec& spec, const Grid&, ModelForm& form) {
            const double from = spec.number("from_mm");
            const double to = spec.number("to_mm");
            const double amount = spec.number("amount");
            form.placed.gains.push_back({[from, to, amount](const Spot& spot) {
                                           return spot.y_mm >= from && spot.y_mm < to ? amount : 0;
                                         },
                                         std::abs(amount)});
          }};
}

}  // namespace binderjet
