// SPDX-License-Identifier: GPL-3.0-or-later
// Infiltrant: glue or wax drawn into the finished part fills narrow gaps and concave corners, and
// leaves a skin.
//
//   radius_mm: gaps narrower than twice this are filled (morphological closing by a ball)
//   skin_mm: how much every face grows, 0 to radius_mm
#pragma once

#include "slicer/model/effects/effect.h"

namespace binderjet {

EffectKind infiltrant_kind();

}  // namespace binderjet
