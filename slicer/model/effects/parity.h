// SPDX-License-Identifier: GPL-3.0-or-later
// Parity: printing both ways, even layers land by_mm beside their place and odd ones as far on the
// other side.
//
//   by_mm = [x, y]
#pragma once

#include "slicer/model/effects/effect.h"

namespace binderjet {

EffectKind parity_kind();

}  // namespace binderjet
