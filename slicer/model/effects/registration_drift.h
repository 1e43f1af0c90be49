// SPDX-License-Identifier: GPL-3.0-or-later
// Registration drift: each layer lands a little further beside its place than the one below.
//
//   per_mm = [x, y]: mm of shift for each mm of height
#pragma once

#include "slicer/model/effects/effect.h"

namespace binderjet {

EffectKind registration_drift_kind();

}  // namespace binderjet
