// SPDX-License-Identifier: GPL-3.0-or-later
// Infiltrant: glue or wax drawn into the finished part fills narrow gaps and concave corners, and
// leaves a skin.
//
//   radius_mm: gaps narrower than twice this are filled (morphological closing by a ball); above 0,
//              at most 1
//   skin_mm: how much every face grows, from 0 to 1; what is more than radius_mm counts as that
#include <algorithm>

#include "slicer/model/effects/assembled_model.h"
#include "slicer/model/effects/candidates.h"
#include "slicer/model/wear/morphology.h"

namespace binderjet {
namespace {

// Grown by the ball, and taken back by one that is smaller by the skin.
void write_into(const EffectSpec& spec, const Grid& grid, AssembledModel& form) {
  const double radius = spec.number("radius_mm");
  const Ellipsoid out(radius, grid);
  const Ellipsoid back(std::max(0.0, radius - spec.number("skin_mm")), grid);
  const auto reach = [](const Ellipsoid& by) {
    const auto [x, y, z] = by.reach();
    return Reach{{x, y}, z, z};
  };
  form.wear.push_back(
      {reach(out), [out](const RunWindow& window) { return dilated(window, out); }});
  form.wear.push_back({reach(back), [back](const RunWindow& window) {
                         return eroded(window, back, Beyond::kSame);
                       }});
}

EffectSpec effect(double radius_mm, double skin_mm) {
  return {"infiltrant", {}, {{"radius_mm", {radius_mm}}, {"skin_mm", {skin_mm}}}};
}

void add_trials(TrialList& list) {
  for (const double radius_mm : {0.12, 0.25}) {
    for (const double skin_mm : {0.0, 0.06}) {
      list.wears.push_back(
          {effect(radius_mm, skin_mm), {Covariate::Axis::kFacing, Covariate::Form::kLocal}});
    }
  }
}

}  // namespace

EffectKind infiltrant_effect() {
  return {.name = "infiltrant",
          .numbers = {{.name = "radius_mm", .min = 0, .max = 1, .search_step = one_tenth},
                      {.name = "skin_mm", .min = -1e-9, .max = 1, .search_step = one_voxel_y}},
          .write_into = write_into,
          .examples = {effect(0.2, 0.1)},
          .once = true,
          .add_trials = add_trials};
}

}  // namespace binderjet
