// SPDX-License-Identifier: GPL-3.0-or-later
// Bleed down: what a layer has too much of seeps into the layers below it.
//
//   share: layer k gets share^j of the binder of layer k + j, beside its own; above 0, at most 0.9
#include "slicer/model/effects/assembled_model.h"
#include "slicer/model/effects/candidates.h"

namespace binderjet {
namespace {

// Shares too small to move an edge by a hundredth of a kernel are left out.
constexpr double kMinShare = 0.01;
constexpr int kMaxLayers = 8;

void write_into(const EffectSpec& spec, const Grid&, AssembledModel& form) {
  const std::vector<DoseTerm> own = form.terms;
  double share = 1;
  for (int j = 1; j <= kMaxLayers; ++j) {
    share *= spec.number("share");
    if (share < kMinShare) break;
    for (DoseTerm term : own) {
      term.layer += j;
      term.gain *= share;
      form.terms.push_back(term);
    }
  }
}

EffectSpec effect(double share) { return {"z_bleed_down", {}, {{"share", {share}}}}; }

}  // namespace

EffectKind z_bleed_down_effect() {
  return {
      .name = "z_bleed_down",
      .numbers = {{.name = "share", .min = 0, .max = 0.9, .fit_step = 0.01}},
      .write_into = write_into,
      .examples = {effect(0.4)},
      .once = true,
      .add_candidates = [](CandidateList& list) {
        list.add_from_zero({Covariate::Axis::kZ, Covariate::Form::kTrend}, 0.1, effect, 0.01, 0.85);
      }};
}

}  // namespace binderjet
