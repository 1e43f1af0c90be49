// SPDX-License-Identifier: GPL-3.0-or-later
// Bands: the dose rises and falls over the bed with the head's pitch or its swath.
//
//   direction_deg: from x (0) to y (90), across the bands; period_mm;
//   wave = [c, s]: the dose is multiplied by 1 + c cos(2 pi u / period) + s sin(2 pi u / period),
//   u being the place on the bed along the direction
#pragma once

#include "slicer/model/effects/effect.h"

namespace binderjet {

EffectKind band_swath_kind();

}  // namespace binderjet
