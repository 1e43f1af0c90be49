// SPDX-License-Identifier: GPL-3.0-or-later
// Empirical: a measured dependence without a mechanism, by what it depends on.
//
//   acts = "dose" | "shift_x" | "shift_y": the dose is multiplied by 1 + f(u), or the masks are
//          shifted by f(u) mm
//   axis = "x" | "y" | "z": u is the place on the bed in mm
//        | "layer": the number of the layer
//        | "direction": the place along direction_deg, in mm
//        | "density": the solid share within radius_mm
//        | "edge_distance": the way from the side of the job's box, in mm
//        | "position": the way from center_mm = [x, y]
//   form = "trend": amount (u - from)
//        | "step": amount from `at` on
//        | "window": amount from `from` to `to`
//        | "local": amount exp(-(u - at)^2 / (2 width^2))
//        | "periodic": c cos(2 pi u / period) + s sin(2 pi u / period), wave = [c, s]
#pragma once

#include "slicer/model/effects/effect.h"

namespace binderjet {

EffectKind empirical_kind();

}  // namespace binderjet
