// SPDX-License-Identifier: GPL-3.0-or-later
// Survive (paper, section 3): bound powder that is too thin is brushed off in the cleaning.
//
//   width_mm = [x, y]: what is thinner than this along x or y, within its layer, does not survive
#pragma once

#include "slicer/model/effects/effect.h"

namespace binderjet {

EffectKind survive_kind();

}  // namespace binderjet
