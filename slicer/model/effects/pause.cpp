// SPDX-License-Identifier: GPL-3.0-or-later
// Pause: from one height on the dose is another, since the powder dried or a head was cleaned.
//
//   at_mm: the height, from 0 on
//   amount: the dose is multiplied by 1 + amount from there on; above -0.95, at most 2
#include <algorithm>
#include <cmath>

#include "slicer/model/effects/assembled_model.h"
#include "slicer/model/effects/candidates.h"

namespace binderjet {
namespace {

void write_into(const EffectSpec& spec, const Grid&, AssembledModel& form) {
  const double at = spec.number("at_mm");
  const double amount = spec.number("amount");
  form.placed.gains.push_back(
      {[at, amount](const Spot& spot) { return spot.z_mm >= at ? amount : 0; }, std::abs(amount)});
}

EffectSpec effect(double at_mm, double amount) {
  return {"pause", {}, {{"at_mm", {at_mm}}, {"amount", {amount}}}};
}

void add_candidates(CandidateList& list) {
  const JobExtent& job = list.job();
  for (int k = 2; k <= job.layers - 2; ++k) {
    const double at_mm = job.layer_mm(job.first_layer) + job.layer_mm(k);
    list.add_effect({Covariate::Axis::kZ, Covariate::Form::kStep, {{"at_mm", {at_mm}}}},
                    {dose_column([at_mm](const Spot& s) { return s.z_mm >= at_mm ? 1.0 : 0.0; })},
                    kAlongZ,
                    [at_mm](Coefficients c) { return effect(at_mm, std::clamp(c[0], -0.9, 1.9)); });
  }
}

}  // namespace

EffectKind pause_effect() {
  return {.name = "pause",
          .numbers = {{.name = "at_mm", .min = -1e-9, .max = 1000, .search_step = one_layer},
                      {.name = "amount", .min = -0.95, .max = 2, .fit_step = 0.005}},
          .write_into = write_into,
          .examples = {effect(0.25, 0.3)},
          .add_candidates = add_candidates};
}

}  // namespace binderjet
