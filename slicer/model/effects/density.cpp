// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/model/effects/density.h"

#include <cmath>

#include "slicer/model/effects/assembled_model.h"

namespace binderjet {
namespace {

void add(const EffectSpec& spec, const Grid&, AssembledModel& form) {
  const double radius_mm = spec.number("radius_mm");
  form.ask_density(radius_mm);
  const double strength = spec.number("strength");
  const double reference = spec.number("reference");
  form.placed.gains.push_back(
      {[strength, reference](const Spot& spot) { return strength * (spot.density - reference); },
       std::abs(strength)});
}

}  // namespace

EffectKind density_kind() {
  return {"density",
          {},
          {{"strength", 1, -5, 5}, {"radius_mm", 1, 0, 10}, {"reference", 1, -1e-9, 1}},
          add};
}

}  // namespace binderjet
