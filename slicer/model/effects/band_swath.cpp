// SPDX-License-Identifier: GPL-3.0-or-later
// Bands: the dose rises and falls over the bed with the head's pitch or its swath.
//
//   direction_deg: across the bands, from x (0) to y (90)
//   period_mm: above 0, at most 1000
//   wave = [c, s]: the dose is multiplied by 1 + c cos(2 pi u / period) + s sin(2 pi u / period), u
//   being the place on the bed along the direction in mm; above -2, at most 2
#include <cmath>
#include <numbers>

#include "slicer/model/effects/assembled_model.h"
#include "slicer/model/effects/candidates.h"

namespace binderjet {
namespace {

void write_into(const EffectSpec& spec, const Grid&, AssembledModel& form) {
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

EffectSpec effect(double direction_deg, double period_mm, double c, double s) {
  return {"band_swath",
          {},
          {{"direction_deg", {direction_deg}}, {"period_mm", {period_mm}}, {"wave", {c, s}}}};
}

// Across x or y; other directions are the scan's.
void add_candidates(CandidateList& list) {
  for (std::size_t axis = 0; axis < 2; ++axis) {
    constexpr double kShortestMm = 0.9;
    for (const double f : frequencies(list.job().place.size_mm[axis], kShortestMm)) {
      const double turn = 2 * std::numbers::pi * f;
      const auto along = [axis](const Spot& s) { return axis == 0 ? s.x_mm : s.y_mm; };
      const double period = 1 / f;
      list.add_effect({axis == 0 ? Covariate::Axis::kX : Covariate::Axis::kY,
                       Covariate::Form::kPeriodic,
                       {{"period_mm", {period}}}},
                      {dose_column([=](const Spot& s) { return std::cos(turn * along(s)); }),
                       dose_column([=](const Spot& s) { return std::sin(turn * along(s)); })},
                      axis == 0 ? kAlongX : kAlongY, [axis, period](Coefficients c) {
                        return effect(axis == 0 ? 0.0 : 90.0, period, c[0], c[1]);
                      });
    }
  }
}

// What runs along an axis of the printer has no reason to be turned by a little.
bool is_askew(const EffectSpec&, double direction_deg) { return std::fmod(direction_deg, 90) != 0; }

}  // namespace

EffectKind band_swath_effect() {
  return {
      .name = "band_swath",
      .numbers =
          {{.name = "direction_deg", .min = -360, .max = 360, .fit_step = 0.5, .fits = is_askew},
           {.name = "period_mm", .min = 0, .max = 1000, .fit_share = 0.002},
           {.name = "wave", .count = 2, .min = -2, .max = 2, .fit_step = 0.003}},
      .write_into = write_into,
      .examples = {effect(30, 1.3, 0.2, 0.1)},
      .add_candidates = add_candidates,
      .update_covariate = [](const EffectSpec& fitted, Covariate& covariate) {
        covariate.numbers["period_mm"] = fitted.numbers.at("period_mm");
      }};
}

}  // namespace binderjet
