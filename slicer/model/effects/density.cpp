// SPDX-License-Identifier: GPL-3.0-or-later
// Density: binder goes where powder is already wet, so massive neighborhoods get more of it.
//
//   strength: the dose is multiplied by 1 + strength (share - reference), where share is the solid
//             share of the masks around, 0 to 1; above -5, at most 5, negative: massive parts get
//             less
//   radius_mm: half the width of the box around, in x, y and z; above 0, at most 10
//   reference: the share at which the dose is what it is without the effect, 0 to 1
#include <cmath>

#include "slicer/model/effects/assembled_model.h"
#include "slicer/model/effects/candidates.h"
#include "slicer/model/effects/level.h"

namespace binderjet {
namespace {

void write_into(const EffectSpec& spec, const Grid&, AssembledModel& form) {
  form.ask_density(spec.number("radius_mm"));
  const double strength = spec.number("strength");
  const double reference = spec.number("reference");
  form.placed.gains.push_back(
      {[strength, reference](const Spot& spot) { return strength * (spot.density - reference); },
       std::abs(strength)});
}

EffectSpec effect(double strength, double radius_mm, double reference) {
  return {"density",
          {},
          {{"strength", {strength}}, {"radius_mm", {radius_mm}}, {"reference", {reference}}}};
}

void add_candidates(CandidateList& list) {
  constexpr double kStep = 0.05;
  constexpr double kReference = 0.5;
  for (const double radius_mm : {0.75, 1.1, 1.5, 2.0, 2.5, 3.2, 4.0}) {
    const Column column{.basis = Column::Basis::kModel,
                        .nudged = with_effect(list.model(), effect(kStep, radius_mm, kReference)),
                        .step = kStep};
    list.add({Covariate::Axis::kDensity, Covariate::Form::kTrend}, {column, dose_column()},
             kNowhere, [model = list.model(), radius_mm](Coefficients c) {
               return with_effect(with_level_gain(model, c[1]),
                                  effect(c[0], radius_mm, kReference));
             });
  }
}

}  // namespace

EffectKind density_effect() {
  return {.name = "density",
          .numbers = {{.name = "strength", .min = -5, .max = 5, .fit_step = 0.02},
                      {.name = "radius_mm", .min = 0, .max = 10, .fit_share = 0.05},
                      {.name = "reference", .min = -1e-9, .max = 1}},
          .write_into = write_into,
          .examples = {effect(0.5, 0.4, 0.3)},
          .once = true,
          .add_candidates = add_candidates,
          .length_causes = {{LengthTerm::kBedPlace, false}}};
}

}  // namespace binderjet
