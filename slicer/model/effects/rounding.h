// SPDX-License-Identifier: GPL-3.0-or-later
// Rounding: handling and compressed air wear off the edges and corners of the printed part.
//
//   shape = "ball": what no ball of radius_mm fits into is gone (morphological opening)
//         | "disc": the same within each layer, where flat faces and what lies on the bed are
//         spared | "gaussian": the part is smoothed with this standard deviation along x, y and z,
//         and
//           solid from a half on: convex edges wear off, concave ones fill
#pragma once

#include "slicer/model/effects/effect.h"

namespace binderjet {

EffectKind rounding_kind();

}  // namespace binderjet
