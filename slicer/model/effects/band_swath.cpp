// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/model/effects/band_swath.h"

#include <cmath>
#include <numbers>

#include "slicer/model/effects/assembled_model.h"

namespace binderjet {
namespace {

void add(const EffectSpec& spec, const Grid&, AssembledModel& form) {
  const double angle = spec.number("direction_deg") * std::numbers::pi / 180;
  const double turn = 2 * std::numbers::pi / spec.number("period_mm");
  const double x = turn * std::cos(angle);
  const double y = turn * std::sin(angle);
  const double c = spec.number("wave", 0);
  const double s = spec.number("wave", 1);
  form.placed.gains.push_back({[x, y, c, s](const Spot& spot) {
                                 const double phase = x * spot.x_mm + y * spot.y_mm;
                                 return c * std::cos(phase) + s * std::sin(phase);
                               },
                               std::hypot(c, s)});
}

}  // namespace

EffectKind band_swath_kind() {
  return {"band_swath",
          {},
          {{"direction_deg", 1, -360, 360}, {"period_mm", 1, 0, 1000}, {"wave", 2, -2, 2}},
          add};
}

}  // namespace binderjet
