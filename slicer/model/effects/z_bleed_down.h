// SPDX-License-Identifier: GPL-3.0-or-later
// Bleed down: what a layer has too much of seeps into the layers below it.
//
//   share: layer k gets share^j of the binder of layer k + j, 0 to 0.9
#pragma once

#include "slicer/model/effects/effect.h"

namespace binderjet {

EffectKind z_bleed_down_kind();

}  // namespace binderjet
