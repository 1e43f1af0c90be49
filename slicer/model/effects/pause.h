// SPDX-License-Identifier: GPL-3.0-or-later
// Pause: from one height on the dose is another, since the powder dried or a head was cleaned.
//
//   at_mm: the height; amount: the dose is multiplied by 1 + amount from there on
#pragma once

#include "slicer/model/effects/effect.h"

namespace binderjet {

EffectKind pause_kind();

}  // namespace binderjet
