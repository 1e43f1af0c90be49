// SPDX-License-Identifier: GPL-3.0-or-later
// Bed gradient: the dose changes over the bed, as a plane and a bowl around a center.
//
//   The dose is multiplied by 1 + per_mm . d + per_mm2 d^2, d being the way from center_mm in mm.
//   per_mm = [x, y]: above -1, at most 1; positive: more binder toward larger x and y
//   per_mm2: above -1, at most 1; positive: more binder at the rim
//   center_mm = [x, y]: a place on the bed
#include <algorithm>
#include <cmath>

#include "slicer/model/effects/assembled_model.h"
#include "slicer/model/effects/candidates.h"
#include "slicer/model/effects/level.h"

namespace binderjet {
namespace {

void write_into(const EffectSpec& spec, const Grid&, AssembledModel& form) {
  const std::array<double, 2> per = spec.pair("per_mm");
  const double bowl = spec.number("per_mm2");
  const std::array<double, 2> center = spec.pair("center_mm");
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

EffectSpec effect(double per_x, double per_y, double per2, const std::array<double, 2>& center) {
  return {"grad_bed",
          {},
          {{"per_mm", {per_x, per_y}}, {"per_mm2", {per2}}, {"center_mm", {center[0], center[1]}}}};
}

// A gradient around a center at which nothing changes, and what changes there as another level.
void add_candidates(CandidateList& list) {
  const std::array<double, 2> center = list.job().center_mm();
  const Column x = dose_column([center](const Spot& s) { return s.x_mm - center[0]; });
  const Column y = dose_column([center](const Spot& s) { return s.y_mm - center[1]; });
  const Column bowl = dose_column([center](const Spot& s) {
    const double dx = s.x_mm - center[0];
    const double dy = s.y_mm - center[1];
    return dx * dx + dy * dy;
  });
  const Column all = dose_column();
  const auto model_of = [model = list.model(), center](double per_x, double per_y, double per2,
                                                       double gain) {
    const double g = 1 + gain;
    return with_effect(with_level_gain(model, gain),
                       effect(per_x / g, per_y / g, per2 / g, center));
  };
  using Axis = Covariate::Axis;
  list.add({Axis::kX, Covariate::Form::kTrend}, {x, all}, kAlongX,
           [model_of](Coefficients c) { return model_of(c[0], 0, 0, c[1]); });
  list.add({Axis::kY, Covariate::Form::kTrend}, {y, all}, kAlongY,
           [model_of](Coefficients c) { return model_of(0, c[0], 0, c[1]); });
  list.add({Axis::kPosition, Covariate::Form::kTrend}, {x, y, all}, kAlongX | kAlongY,
           [model_of](Coefficients c) { return model_of(c[0], c[1], 0, c[2]); });
  list.add({Axis::kPosition, Covariate::Form::kLocal}, {bowl, x, y, all}, kAlongX | kAlongY,
           [model_of](Coefficients c) { return model_of(c[1], c[2], c[0], c[3]); });
}

}  // namespace

EffectKind grad_bed_effect() {
  return {.name = "grad_bed",
          .numbers = {{.name = "per_mm", .count = 2, .min = -1, .max = 1, .fit_step = 0.001},
                      {.name = "per_mm2", .min = -1, .max = 1, .fit_step = 0.0002},
                      // A plane and a bowl say the same around any center.
                      {.name = "center_mm", .count = 2, .min = -1000, .max = 1000}},
          .write_into = write_into,
          .examples = {effect(0.05, -0.1, 0.02, {1, 2})},
          .add_candidates = add_candidates,
          .length_causes = {{LengthTerm::kBedPlace}}};
}

}  // namespace binderjet
