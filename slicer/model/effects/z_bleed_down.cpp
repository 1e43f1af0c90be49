// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/model/effects/z_bleed_down.h"

#include "slicer/model/effects/assembled_model.h"

namespace binderjet {
namespace {

// Shares too small to move an edge by a hundredth of a kernel are left out.
constexpr double kLeastShare = 0.01;
constexpr int kMostLayers = 8;

void add(const EffectSpec& spec, const Grid&, AssembledModel& form) {
  const std::vector<DoseTerm> own = form.terms;
  double share = 1;
  for (int j = 1; j <= kMostLayers; ++j) {
    share *= spec.number("share");
    if (share < kLeastShare) break;
    for (DoseTerm term : own) {
      term.layer += j;
      term.gain *= share;
      form.terms.push_back(term);
    }
  }
}

}  // namespace

EffectKind z_bleed_down_kind() { return {"z_bleed_down", {}, {{"share", 1, 0, 0.9}}, add}; }

}  // namespace binderjet
