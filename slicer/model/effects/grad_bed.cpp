// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/model/effects/grad_bed.h"

#include <algorithm>
#include <cmath>

#include "slicer/model/effects/assembled_model.h"

namespace binderjet {
namespace {

void add(const EffectSpec& spec, const Grid&, AssembledModel& form) {
  const std::array<double, 2> per{spec.number("per_mm", 0), spec.number("per_mm", 1)};
  const double bowl = spec.number("per_mm2");
  const std::array<double, 2> center{spec.number("center_mm", 0), spec.number("center_mm", 1)};
  const auto amount = [per, bowl, center](const Spot& spot) {
    const double dx = spot.x_mm - center[0];
    const double dy = spot.y_mm - center[1];
    return per[0] * dx + per[1] * dy + bowl * (dx * dx + dy * dy);
  };
  // Largest where a corner of the job is farthest away, however the signs are.
  double far_x = 0;
  double far_y = 0;
  for (const double side : {0.0, 1.0}) {
    const JobPlace& place = form.place;
    far_x = std::max(far_x, std::abs(place.origin_mm[0] + side * place.size_mm[0] - center[0]));
    far_y = std::max(far_y, std::abs(place.origin_mm[1] + side * place.size_mm[1] - center[1]));
  }
  form.placed.gains.push_back({amount, std::abs(per[0]) * far_x + std::abs(per[1]) * far_y +
                                           std::abs(bowl) * (far_x * far_x + far_y * far_y)});
}

}  // namespace

EffectKind grad_bed_kind() {
  return {"grad_bed",
          {},
          {{"per_mm", 2, -1, 1}, {"per_mm2", 1, -1, 1}, {"center_mm", 2, -1000, 1000}},
          add};
}

}  // namespace binderjet
