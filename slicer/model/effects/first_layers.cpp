// SPDX-License-Identifier: GPL-3.0-or-later
// First layers: on the bed's bottom there is no dry powder to draw binder down, so it stays.
//
//   The dose is multiplied by 1 + amount exp(-z / height_mm).
//   amount: above -0.95, at most 5; positive: more binder at the bottom
//   height_mm: above 0, at most 100
#include <algorithm>
#include <cmath>

#include "slicer/model/effects/assembled_model.h"
#include "slicer/model/effects/candidates.h"

namespace binderjet {
namespace {

void write_into(const EffectSpec& spec, const Grid&, AssembledModel& form) {
  const double amount = spec.number("amount");
  const double height = spec.number("height_mm");
  form.placed.gains.push_back(
      {[amount, height](const Spot& spot) { return amount * std::exp(-spot.z_mm / height); },
       std::abs(amount)});
}

EffectSpec effect(double amount, double height_mm) {
  return {"first_layers", {}, {{"amount", {amount}}, {"height_mm", {height_mm}}}};
}

void add_candidates(CandidateList& list) {
  for (const double height_mm : {0.1, 0.2, 0.4, 0.8}) {
    list.add_effect(
            {Covariate::Axis::kZ,
             Covariate::Form::kWindow,
             {{"from_mm", {0}}, {"to_mm", {2 * height_mm}}}},
            {dose_column([height_mm](const Spot& s) { return std::exp(-s.z_mm / height_mm); })},
            kAlongZ,
            [height_mm](Coefficients c) { return effect(std::clamp(c[0], -0.9, 4.5), height_mm); })
        .has_given_place = true;
  }
}

}  // namespace

EffectKind first_layers_effect() {
  return {.name = "first_layers",
          .numbers = {{.name = "amount", .min = -0.95, .max = 5, .fit_step = 0.005},
                      {.name = "height_mm", .min = 0, .max = 100, .fit_share = 0.05}},
          .write_into = write_into,
          .examples = {effect(0.5, 0.2)},
          .add_candidates = add_candidates,
          .length_causes = {{LengthTerm::kLayerShift, false}}};
}

}  // namespace binderjet
