// SPDX-License-Identifier: GPL-3.0-or-later
// Wicking up: a fresh layer draws binder from the wet one below it.
//
//   share: layer k gets this share of the binder of layer k - 1, beside its own; above 0, at most
//   0.9
#include "slicer/model/effects/assembled_model.h"
#include "slicer/model/effects/candidates.h"

namespace binderjet {
namespace {

void write_into(const EffectSpec& spec, const Grid&, AssembledModel& form) {
  for (DoseTerm term : std::vector<DoseTerm>(form.terms)) {
    term.layer -= 1;
    term.gain *= spec.number("share");
    form.terms.push_back(term);
  }
}

EffectSpec effect(double share) { return {"z_wick_up", {}, {{"share", {share}}}}; }

}  // namespace

EffectKind z_wick_up_effect() {
  return {
      .name = "z_wick_up",
      .numbers = {{.name = "share", .min = 0, .max = 0.9, .fit_step = 0.01}},
      .write_into = write_into,
      .examples = {effect(0.3)},
      .once = true,
      .add_candidates = [](CandidateList& list) {
        list.add_from_zero({Covariate::Axis::kZ, Covariate::Form::kTrend}, 0.1, effect, 0.01, 0.85);
      }};
}

}  // namespace binderjet
