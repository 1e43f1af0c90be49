// SPDX-License-Identifier: GPL-3.0-or-later
// Wicking up: a fresh layer draws binder from the wet one below it.
//
//   share: layer k gets this share of the binder of layer k - 1, 0 to 0.9
#pragma once

#include "slicer/model/effects/effect.h"

namespace binderjet {

EffectKind z_wick_up_kind();

}  // namespace binderjet
