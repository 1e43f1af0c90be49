// SPDX-License-Identifier: GPL-3.0-or-later
// Threshold (paper, 4.1): a voxel is printed iff its dose reaches the level.
//
//   level: the least dose that binds powder, above 0, at most 1; 1 is the dose within a wide solid
#include <fmt/format.h>

#include "slicer/model/effects/assembled_model.h"
#include "slicer/model/effects/candidates.h"
#include "slicer/model/effects/level.h"

namespace binderjet {
namespace {

void write_into(const EffectSpec& spec, const Grid&, AssembledModel& form) {
  form.bind_at(spec.number("level"));
}

// Another level, whichever effect of the model says it.
void add_candidates(CandidateList& list) {
  const EffectList& model = list.model();
  list.add({Covariate::Axis::kFacing, Covariate::Form::kConstant},
           {{.basis = Column::Basis::kLevel}}, kNowhere,
           [model](Coefficients c) { return with_level(model, level_of(model) - c[0]); })
      .effect = level_place(model);
}

void add_gauge_changes(const EffectList& declared, std::vector<GaugeChange>& out) {
  const std::size_t place = level_place(declared);
  if (place == declared.size()) return;
  out.push_back({"threshold", evenly(0.01, 0.99, 99),
                 [=](double level) {
                   EffectList effects = declared;
                   effects[place].numbers["level"] = {level};
                   return effects;
                 },
                 [was = level_of(declared)](double level) {
                   return fmt::format("powder binds at a dose of {:.2f}, not {:g}", level, was);
                 }});
}

}  // namespace

EffectKind threshold_effect() {
  return {.name = "threshold",
          .numbers = {{.name = "level",
                       .min = 0,
                       .max = 1,
                       .role = NumberRole::kLevel,
                       .drift_step = kLevelDrift,
                       .fit_step = 0.005}},
          .write_into = write_into,
          .examples = {{"threshold", {}, {{"level", {0.375}}}}},
          .add_candidates = add_candidates,
          .add_gauge_changes = add_gauge_changes,
          .length_causes = {{LengthTerm::kOffset}, {LengthTerm::kScale, false}}};
}

}  // namespace binderjet
