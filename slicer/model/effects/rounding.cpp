// SPDX-License-Identifier: GPL-3.0-or-later
// Rounding: handling and compressed air wear off the edges and corners of the printed part.
//
//   shape = "ball":     what no ball of radius_mm fits into is gone (morphological opening)
//         | "disc":     the same within each layer: flat faces and what lies on the bed are spared
//         | "gaussian": the part is smoothed with radius_mm as standard deviation along x, y and z,
//                       and solid from a half on: convex edges wear off, concave ones fill
//   radius_mm: above 0, at most 0.5
#include "slicer/model/effects/assembled_model.h"
#include "slicer/model/effects/candidates.h"
#include "slicer/model/wear/morphology.h"
#include "slicer/model/wear/smoothing.h"

namespace binderjet {
namespace {

void add_opening(const Ellipsoid& ball, AssembledModel& form) {
  const auto [x, y, z] = ball.reach();
  const Reach reach{{x, y}, z, z};
  form.wear.push_back(
      {reach, [ball](const RunWindow& window) { return eroded(window, ball, Beyond::kPowder); }});
  form.wear.push_back({reach, [ball](const RunWindow& window) { return dilated(window, ball); }});
}

void add_gaussian(double radius_mm, const Grid& grid, AssembledModel& form) {
  const Smoothing smoothing(radius_mm, grid);
  const auto [x, y, z] = smoothing.reach();
  form.wear.push_back({{{x, y}, z, z}, smoothing});
}

void write_into(const EffectSpec& spec, const Grid& grid, AssembledModel& form) {
  const double radius_mm = spec.number("radius_mm");
  const std::string& shape = spec.words.at("shape");
  if (shape == "ball") add_opening(Ellipsoid(radius_mm, grid), form);
  if (shape == "disc") add_opening(Ellipsoid::disc(radius_mm, grid), form);
  if (shape == "gaussian") add_gaussian(radius_mm, grid, form);
}

EffectSpec effect(const char* shape, double radius_mm) {
  return {"rounding", {{"shape", shape}}, {{"radius_mm", {radius_mm}}}};
}

void add_trials(TrialList& list) {
  const Covariate covariate{Covariate::Axis::kFacing, Covariate::Form::kLocal};
  for (const double radius_mm : {0.07, 0.13}) {
    list.wears.push_back({effect("gaussian", radius_mm), covariate});
  }
  for (const char* shape : {"disc", "ball"}) {
    for (const double radius_mm : {0.11, 0.21}) {
      list.wears.push_back({effect(shape, radius_mm), covariate});
    }
  }
}

}  // namespace

EffectKind rounding_effect() {
  return {.name = "rounding",
          .words = {{"shape", {"ball", "disc", "gaussian"}}},
          .numbers = {{.name = "radius_mm", .min = 0, .max = 0.5, .search_step = one_tenth}},
          .write_into = write_into,
          .examples = {effect("ball", 0.2), effect("disc", 0.3), effect("gaussian", 0.15)},
          .once = true,
          .add_trials = add_trials};
}

}  // namespace binderjet
