// SPDX-License-Identifier: GPL-3.0-or-later
// Height gradient: the dose changes with the height of the build.
//
//   per_mm: the dose is multiplied by 1 + per_mm (z - from_mm), within -0.9 and 0.9
#pragma once

#include "slicer/model/effects/effect.h"

namespace binderjet {

EffectKind grad_z_kind();

}  // namespace binderjet
