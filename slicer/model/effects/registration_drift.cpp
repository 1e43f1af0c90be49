// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/model/effects/registration_drift.h"

#include "slicer/model/effects/assembled_model.h"

namespace binderjet {
EffectKind registration_drift_kind() {
  return {"registration_drift",
          {},
          {{"per_mm", 2, -1, 1}},
          [](const EffectSpec& spec, const Grid&, AssembledModel& form) {
            const std::array<double, 2> per{spec.number("per_mm", 0), spec.number("per_mm", 1)};
            constexpr double kBedHeightMm = 20;
            form.shift(
                [per](const Spot& spot) -> std::array<double, 2> {
                  return {per[0] * spot.z_mm, per[1] * spot.z_mm};
                },
                {per[0] * kBedHeightMm, per[1] * kBedHeightMm});
          }};
}

}  // namespace binderjet
