// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/model/effects/grad_z.h"

#include <algorithm>

#include "slicer/model/effects/assembled_model.h"

namespace binderjet {
EffectKind grad_z_kind() {
  return {"grad_z",
          {},
          {{"per_mm", 1, -1, 1}, {"from_mm", 1, -1e-9, 1000}},
          [](const EffectSpec& spec, const Grid&, AssembledModel& form) {
            const double per = spec.number("per_mm");
            const double from = spec.number("from_mm");
            static constexpr double kMost = 0.9;
            form.placed.gains.push_back({[per, from](const Spot& spot) {
                                           return std::clamp(per * (spot.z_mm - from), -kMost,
                                                             kMost);
                                         },
                                         kMost});
          }};
}

}  // namespace binderjet
