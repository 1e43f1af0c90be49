// SPDX-License-Identifier: GPL-3.0-or-later
// Registration drift: each layer lands a little further beside its place than the one below.
//
//   per_mm = [x, y]: mm of shift, toward larger x and y on the bed, for each mm of height; above
//   -1, at most 1
#include "slicer/model/effects/assembled_model.h"
#include "slicer/model/effects/candidates.h"

namespace binderjet {
namespace {

void write_into(const EffectSpec& spec, const Grid&, AssembledModel& form) {
  const std::array<double, 2> per = spec.pair("per_mm");
  constexpr double kBedHeightMm = 20;
  form.shift(
      [per](const Spot& spot) -> std::array<double, 2> {
        return {per[0] * spot.z_mm, per[1] * spot.z_mm};
      },
      {per[0] * kBedHeightMm, per[1] * kBedHeightMm});
}

EffectSpec effect(double x, double y) { return {"registration_drift", {}, {{"per_mm", {x, y}}}}; }

void add_candidates(CandidateList& list) {
  const auto height = [](const Spot& s) { return s.z_mm; };
  list.add_effect({Covariate::Axis::kZ, Covariate::Form::kTrend},
                  {shift_column(0, height), shift_column(1, height)}, kAlongZ,
                  [](Coefficients c) { return effect(c[0], c[1]); });
}

}  // namespace

EffectKind registration_drift_effect() {
  return {.name = "registration_drift",
          .numbers = {{.name = "per_mm", .count = 2, .min = -1, .max = 1, .fit_step = 0.0005}},
          .write_into = write_into,
          .examples = {effect(0.3, -0.2)},
          .add_candidates = add_candidates};
}

}  // namespace binderjet
