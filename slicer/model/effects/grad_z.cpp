// SPDX-License-Identifier: GPL-3.0-or-later
// Height gradient: the dose changes with the height of the build.
//
//   per_mm: the dose is multiplied by 1 + per_mm (z - from_mm), within 0.1 and 1.9; above -1, at
//   most
//           1, positive: more binder further up
//   from_mm: the height at which the dose is what it is without the effect, 0 to 1000
#include <algorithm>

#include "slicer/model/effects/assembled_model.h"
#include "slicer/model/effects/candidates.h"
#include "slicer/model/effects/level.h"

namespace binderjet {
namespace {

void write_into(const EffectSpec& spec, const Grid&, AssembledModel& form) {
  const double per = spec.number("per_mm");
  const double from = spec.number("from_mm");
  static constexpr double kMost = 0.9;
  form.placed.gains.push_back({[per, from](const Spot& spot) {
                                 return std::clamp(per * (spot.z_mm - from), -kMost, kMost);
                               },
                               kMost});
}

EffectSpec effect(double per_mm) {
  return {"grad_z", {}, {{"per_mm", {per_mm}}, {"from_mm", {0}}}};
}

// From the bed on, and what changes there as another level.
void add_candidates(CandidateList& list) {
  list.add({Covariate::Axis::kZ, Covariate::Form::kTrend},
           {dose_column([](const Spot& s) { return s.z_mm; }), dose_column()}, kAlongZ,
           [model = list.model()](Coefficients c) {
             return with_effect(with_level_gain(model, c[1]), effect(c[0] / (1 + c[1])));
           });
}

}  // namespace

EffectKind grad_z_effect() {
  return {.name = "grad_z",
          .numbers = {{.name = "per_mm", .min = -1, .max = 1, .fit_step = 0.001},
                      {.name = "from_mm", .min = -1e-9, .max = 1000}},
          .write_into = write_into,
          .examples = {effect(-0.2)},
          .add_candidates = add_candidates};
}

}  // namespace binderjet
