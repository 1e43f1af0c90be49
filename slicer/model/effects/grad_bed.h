// SPDX-License-Identifier: GPL-3.0-or-later
// Bed gradient: the dose changes over the bed, as a plane and a bowl around a center.
//
//   per_mm = [x, y], per_mm2: the dose is multiplied by 1 + per_mm . d + per_mm2 d^2, d being the
//   way from center_mm on the bed
#pragma once

#include "slicer/model/effects/effect.h"

namespace binderjet {

EffectKind grad_bed_kind();

}  // namespace binderjet
