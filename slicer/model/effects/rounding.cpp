// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/model/effects/rounding.h"

#include "slicer/model/effects/assembled_model.h"
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

void add(const EffectSpec& spec, const Grid& grid, AssembledModel& form) {
  const double radius_mm = spec.number("radius_mm");
  const std::string& shape = spec.words.at("shape");
  if (shape == "ball") add_opening(Ellipsoid(radius_mm, grid), form);
  if (shape == "disc") add_opening(Ellipsoid::disc(radius_mm, grid), form);
  if (shape == "gaussian") add_gaussian(radius_mm, grid, form);
}

}  // namespace

EffectKind rounding_kind() {
  return {"rounding", {{"shape", {"ball", "disc", "gaussian"}}}, {{"radius_mm", 1, 0, 0.5}}, add};
}

}  // namespace binderjet
