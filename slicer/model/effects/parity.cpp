// SPDX-License-Identifier: GPL-3.0-or-later
// Parity: printing both ways, even layers land beside their place and odd ones as far on the other
// side.
//
//   by_mm = [x, y]: of even layers, toward larger x and y on the bed; above -5, at most 5
#include "slicer/model/effects/assembled_model.h"
#include "slicer/model/effects/candidates.h"

namespace binderjet {
namespace {

int sign_of(const Spot& spot) { return spot.layer % 2 == 0 ? 1 : -1; }

void write_into(const EffectSpec& spec, const Grid&, AssembledModel& form) {
  const std::array<double, 2> by = spec.pair("by_mm");
  form.shift(
      [by](const Spot& spot) -> std::array<double, 2> {
        return {sign_of(spot) * by[0], sign_of(spot) * by[1]};
      },
      by);
}

EffectSpec effect(double x, double y) { return {"parity", {}, {{"by_mm", {x, y}}}}; }

void add_candidates(CandidateList& list) {
  const auto sign = [](const Spot& s) { return static_cast<double>(sign_of(s)); };
  list.add_effect({Covariate::Axis::kLayer, Covariate::Form::kPeriodic, {{"period_layers", {2}}}},
                  {shift_column(0, sign), shift_column(1, sign)}, kAlongZ,
                  [](Coefficients c) { return effect(c[0], c[1]); });
}

}  // namespace

EffectKind parity_effect() {
  return {.name = "parity",
          .numbers = {{.name = "by_mm", .count = 2, .min = -5, .max = 5, .fit_step = 0.002}},
          .write_into = write_into,
          .examples = {effect(0.11, 0.03)},
          .add_candidates = add_candidates};
}

}  // namespace binderjet
