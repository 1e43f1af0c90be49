// SPDX-License-Identifier: GPL-3.0-or-later
// Shift: every layer lands beside its place by the same way.
//
//   by_mm = [x, y]: toward larger x and y on the bed; above -5, at most 5
#include "slicer/model/effects/assembled_model.h"
#include "slicer/model/effects/candidates.h"
#include "slicer/model/effects/catalogue.h"

namespace binderjet {
namespace {

void write_into(const EffectSpec& spec, const Grid&, AssembledModel& form) {
  const std::array<double, 2> by = spec.pair("by_mm");
  form.shift([by](const Spot&) { return by; }, by);
}

// A print as a whole may as well have been measured beside its place: the finding gets no name.
void add_candidates(CandidateList& list) {
  Candidate& candidate =
      list.add_effect({Covariate::Axis::kFacing, Covariate::Form::kTrend},
                      {shift_column(0), shift_column(1)}, kNowhere, [](Coefficients c) {
                        return EffectSpec{"shift", {}, {{"by_mm", {c[0], c[1]}}}};
                      });
  candidate.kind = nameless_word();
  candidate.named = false;
}

}  // namespace

EffectKind shift_effect() {
  return {.name = "shift",
          .numbers = {{.name = "by_mm", .count = 2, .min = -5, .max = 5, .fit_step = 0.002}},
          .write_into = write_into,
          .examples = {{"shift", {}, {{"by_mm", {0.07, -0.13}}}}},
          .once = true,
          .add_candidates = add_candidates};
}

}  // namespace binderjet
