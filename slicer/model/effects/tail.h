// SPDX-License-Identifier: GPL-3.0-or-later
// Tail: a share of the binder runs farther than the rest, over a wide gaussian within its layer.
//
//   share: of all binder, 0 to 0.9; width_mm = [x, y]: full width at half the gaussian's height,
//   at most 2: what reaches farther is density's business
#pragma once

#include "slicer/model/effects/effect.h"

namespace binderjet {

EffectKind tail_kind();

}  // namespace binderjet
