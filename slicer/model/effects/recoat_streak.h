// SPDX-License-Identifier: GPL-3.0-or-later
// Streak: a chip on the roller or the blade leaves a line of other powder, from one height on.
//
//   across = "x" | "y": the axis that the line crosses; from_mm, to_mm: its place on the bed along
//   it; at_mm: the height; amount: the dose there is multiplied by 1 + amount
#pragma once

#include "slicer/model/effects/effect.h"

namespace binderjet {

EffectKind recoat_streak_kind();

}  // namespace binderjet
