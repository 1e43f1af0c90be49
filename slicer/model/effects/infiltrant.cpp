// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/model/effects/infiltrant.h"

#include <algorithm>

#include "slicer/model/effects/assembled_model.h"
#include "slicer/model/wear/morphology.h"

namespace binderjet {
namespace {

void add(const EffectSpec& spec, const Grid& grid, AssembledModel& form) {
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

}  // namespace

EffectKind infiltrant_kind() {
  return {"infiltrant", {}, {{"radius_mm", 1, 0, 1}, {"skin_mm", 1, -1e-9, 1}}, add};
}

}  // namespace binderjet
