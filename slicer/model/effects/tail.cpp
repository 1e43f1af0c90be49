// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/model/effects/tail.h"

#include "slicer/model/effects/assembled_model.h"

namespace binderjet {
namespace {

void add(const EffectSpec& spec, const Grid& grid, AssembledModel& form) {
  const double share = spec.number("share");
  const std::vector<DoseTerm> own = form.terms;
  for (DoseTerm& term : form.terms) term.gain *= 1 - share;
  for (DoseTerm term : own) {
    term.gain *= share;
    term.x = gaussian_kernel(spec.number("width_mm", 0) / grid.voxel_mm(0));
    term.y = gaussian_kernel(spec.number("width_mm", 1) / grid.voxel_mm(1));
    form.terms.push_back(term);
  }
}

}  // namespace

EffectKind tail_kind() {
  constexpr double kMaxWidthMm = 2;
  return {"tail", {}, {{"share", 1, 0, 0.9}, {"width_mm", 2, 0, kMaxWidthMm}}, add};
}

}  // namespace binderjet
