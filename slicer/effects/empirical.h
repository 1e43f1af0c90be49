// SPDX-License-Identifier: GPL-3.0-or-later
// Empirical: a measured dependence without a mechanism, by what it depends on.
//
//   acts = "dose" | "shift_x" | "shift_y": the dose is multiplied by 1 + f(u), or the masks are
//   shifted by f(u) mm
//   axis = "x" | "y" | "z" | "layer" | "direction" | "density" | "position": u on the bed in mm,
//   the number of the layer, the place along direction_deg, the solid share within radius_mm, or
//   the distance from center_mm = [x, y] form = "trend": amount (u - from);  "step": amount from
//   `at` on;  "window": amount from `from` to `to`;  "local": amount exp(-(u - at)^2 / (2
//   width^2));  "periodic": wave = [c, s] over `period`
#pragma once

#include "slicer/effects/effect.h"

namespace binderjet {

EffectKind empirical_kind();

}  // namespace binderjet
