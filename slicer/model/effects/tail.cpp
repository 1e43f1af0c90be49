// SPDX-License-Identifier: GPL-3.0-or-later
// Tail: a share of the binder runs farther than the rest, over a wide gaussian within its layer.
//
//   share: of all binder, above 0, at most 0.9
//   width_mm = [x, y]: full width at half the gaussian's height; above 0, at most 2: what reaches
//   farther is the business of the density
#include "slicer/model/effects/assembled_model.h"
#include "slicer/model/effects/candidates.h"

namespace binderjet {
namespace {

constexpr double kMaxMm = 2;

void write_into(const EffectSpec& spec, const Grid& grid, AssembledModel& form) {
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

// Where no effect has said how binder spreads there is nothing of which it could be the tail.
void add_candidates(CandidateList& list) {
  const AssembledModel form = assemble(list.model(), list.job().grid, list.job().place);
  if (form.terms.front().x == Kernel{}) return;
  for (const double width_mm : {0.6, 1.0, 1.6}) {
    list.add_from_zero(
            {Covariate::Axis::kX, Covariate::Form::kLocal}, 0.05,
            [width_mm](double share) {
              return EffectSpec{
                  "tail", {}, {{"share", {share}}, {"width_mm", {width_mm, width_mm}}}};
            },
            0.01, 0.8)
        .kind = "kernel_shape";
  }
}

}  // namespace

EffectKind tail_effect() {
  return {.name = "tail",
          .numbers = {{.name = "share", .min = 0, .max = 0.9, .fit_step = 0.01},
                      {.name = "width_mm", .count = 2, .min = 0, .max = kMaxMm, .fit_share = 0.02}},
          .write_into = write_into,
          .examples = {{"tail", {}, {{"share", {0.3}}, {"width_mm", {0.8, 1.2}}}}},
          .once = true,
          .add_candidates = add_candidates};
}

}  // namespace binderjet
