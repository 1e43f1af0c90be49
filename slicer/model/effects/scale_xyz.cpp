// SPDX-License-Identifier: GPL-3.0-or-later
// Scale: the print shrinks or grows about the middle of the job.
//
//   by = [x, y]: relative, 0.01 is one per cent larger; above -0.1, at most 0.1. (Along z a stack
//   of layers shows nothing.)
#include "slicer/model/effects/assembled_model.h"
#include "slicer/model/effects/candidates.h"

namespace binderjet {
namespace {

void write_into(const EffectSpec& spec, const Grid&, AssembledModel& form) {
  const std::array<double, 2> by = spec.pair("by");
  const std::array<double, 2> center{form.place.center_mm(0), form.place.center_mm(1)};
  form.shift(
      [by, center](const Spot& spot) -> std::array<double, 2> {
        return {by[0] * (spot.x_mm - center[0]), by[1] * (spot.y_mm - center[1])};
      },
      {by[0] * form.place.size_mm[0] / 2, by[1] * form.place.size_mm[1] / 2});
}

EffectSpec effect(double x, double y) { return {"scale_xyz", {}, {{"by", {x, y}}}}; }

void add_candidates(CandidateList& list) {
  const std::array<double, 2> center = list.job().center_mm();
  list.add_effect({Covariate::Axis::kX, Covariate::Form::kTrend},
                  {shift_column(0, [center](const Spot& s) { return s.x_mm - center[0]; }),
                   shift_column(1, [center](const Spot& s) { return s.y_mm - center[1]; })},
                  kAlongX | kAlongY, [](Coefficients c) { return effect(c[0], c[1]); });
}

}  // namespace

EffectKind scale_xyz_effect() {
  return {.name = "scale_xyz",
          .numbers = {{.name = "by", .count = 2, .min = -0.1, .max = 0.1, .fit_step = 0.0003}},
          .write_into = write_into,
          .examples = {effect(0.05, -0.04)},
          .once = true,
          .add_candidates = add_candidates,
          .length_causes = {{LengthTerm::kScale}}};
}

}  // namespace binderjet
