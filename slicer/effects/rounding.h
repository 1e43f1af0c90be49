// SPDX-License-Identifier: GPL-3.0-or-later
// Rounding: edges and corners wear off, as if the dose were smoothed once more in all directions.
//
//   radius_mm: the smoothing's standard deviation, along x, y and z
#pragma once

#include "slicer/effects/effect.h"

namespace binderjet {

EffectKind rounding_kind();

}  // namespace binderjet
