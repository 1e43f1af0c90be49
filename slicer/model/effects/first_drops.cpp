// SPDX-License-Identifier: GPL-3.0-or-later
// First drops: a nozzle that was idle dries, so the first drops of a line are weak.
//
//   after = "line": only at the first pixel of a row along the fast axis (x)
//         | "gap":  after each gap in the row too
//   amount: a drop at s mm from there has 1 - amount exp(-s / length_mm) of its binder; above -1,
//   at
//           most 1, negative: the first drops are strong
//   length_mm: above 0, at most 20
#include <cmath>

#include "slicer/base/error.h"
#include "slicer/model/effects/assembled_model.h"
#include "slicer/model/effects/candidates.h"

namespace binderjet {
namespace {

void write_into(const EffectSpec& spec, const Grid& grid, AssembledModel& form) {
  if (!form.placed.weak_drops.empty()) {
    throw Error(ErrorKind::kBadInput, "effects", "first_drops stands twice; keep one");
  }
  constexpr double kLeast = 0.004;  // weaker than that moves no edge
  const double amount = spec.number("amount");
  const double length = spec.number("length_mm");
  for (int pixel = 0;; ++pixel) {
    const double lacks = amount * std::exp(-(pixel + 0.5) * grid.pitch_mm[0] / length);
    if (std::abs(lacks) < kLeast) break;
    form.placed.weak_drops.push_back(lacks);
  }
  form.placed.weak_after_gaps = spec.words.at("after") == "gap";
}

EffectSpec effect(const char* after, double amount, double length_mm) {
  return {"first_drops", {{"after", after}}, {{"amount", {amount}}, {"length_mm", {length_mm}}}};
}

void add_candidates(CandidateList& list) {
  for (const char* after : {"line", "gap"}) {
    for (const double length_mm : {0.2, 0.5, 1.2, 3.0}) {
      list.add_from_zero(
          {Covariate::Axis::kX, Covariate::Form::kLocal}, 0.1,
          [after, length_mm](double amount) { return effect(after, amount, length_mm); }, 0.02, 1);
    }
  }
}

}  // namespace

EffectKind first_drops_effect() {
  return {.name = "first_drops",
          .words = {{"after", {"line", "gap"}}},
          .numbers = {{.name = "amount", .min = -1, .max = 1, .fit_step = 0.005},
                      {.name = "length_mm", .min = 0, .max = 20, .fit_share = 0.05}},
          .write_into = write_into,
          .examples = {effect("line", 0.7, 0.2), effect("gap", 0.4, 0.5)},
          .once = true,
          .add_candidates = add_candidates};
}

}  // namespace binderjet
