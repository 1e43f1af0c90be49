// SPDX-License-Identifier: GPL-3.0-or-later
// First drops: a nozzle that was idle dries, so the first drops of a line are weak.
//
//   after = "line" | "gap": only at the first pixel of a row along the fast axis, or after each gap
//   amount, length_mm: a drop s from there has 1 - amount exp(-s / length_mm) of its binder
#pragma once

#include "slicer/model/effects/effect.h"

namespace binderjet {

EffectKind first_drops_kind();

}  // namespace binderjet
