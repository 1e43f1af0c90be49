// SPDX-License-Identifier: GPL-3.0-or-later
// Shift: every layer lands beside its place by the same way.
//
//   by_mm = [x, y]
#pragma once

#include "slicer/model/effects/effect.h"

namespace binderjet {

EffectKind shift_kind();

}  // namespace binderjet
