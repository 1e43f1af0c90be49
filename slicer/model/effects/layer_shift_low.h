// SPDX-License-Identifier: GPL-3.0-or-later
// Low layers dragged: the roller shifts the first layers before the bed holds them.
//
//   by_mm = [x, y]: shift on the bed; height_mm: how fast it dies away with height, as exp(-z / h)
#pragma once

#include "slicer/model/effects/effect.h"

namespace binderjet {

EffectKind layer_shift_low_kind();

}  // namespace binderjet
