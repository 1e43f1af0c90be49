// SPDX-License-Identifier: GPL-3.0-or-later
// Low layers dragged: the roller shifts the first layers before the bed holds them.
//
//   by_mm = [x, y]: shift on the bed, toward larger x and y; above -5, at most 5
//   height_mm: how fast it dies away with height, as exp(-z / height_mm); above 0, at most 100
#include <cmath>

#include "slicer/model/effects/assembled_model.h"
#include "slicer/model/effects/candidates.h"

namespace binderjet {
namespace {

void write_into(const EffectSpec& spec, const Grid&, AssembledModel& form) {
  const std::array<double, 2> by = spec.pair("by_mm");
  const double height_mm = spec.number("height_mm");
  form.shift(
      [by, height_mm](const Spot& spot) -> std::array<double, 2> {
        const double rest = std::exp(-spot.z_mm / height_mm);
        return {by[0] * rest, by[1] * rest};
      },
      by);
}

EffectSpec effect(double x, double y, double height_mm) {
  return {"layer_shift_low", {}, {{"by_mm", {x, y}}, {"height_mm", {height_mm}}}};
}

void add_candidates(CandidateList& list) {
  for (const double height_mm : {0.2, 0.4, 0.8, 1.6}) {
    const auto rest = [height_mm](const Spot& s) { return std::exp(-s.z_mm / height_mm); };
    list.add_effect({Covariate::Axis::kZ,
                     Covariate::Form::kWindow,
                     {{"from_mm", {0}}, {"to_mm", {2 * height_mm}}}},
                    {shift_column(0, rest), shift_column(1, rest)}, kAlongZ,
                    [height_mm](Coefficients c) { return effect(c[0], c[1], height_mm); })
        .has_given_place = true;
  }
}

}  // namespace

EffectKind layer_shift_low_effect() {
  return {.name = "layer_shift_low",
          .numbers = {{.name = "by_mm", .count = 2, .min = -5, .max = 5, .fit_step = 0.002},
                      {.name = "height_mm", .min = 0, .max = 100, .fit_share = 0.05}},
          .write_into = write_into,
          .examples = {effect(0.2, 0.1, 0.3)},
          .add_candidates = add_candidates,
          .length_causes = {{LengthTerm::kLayerShift}}};
}

}  // namespace binderjet
