// SPDX-License-Identifier: GPL-3.0-or-later
// Binder spread (paper, 4.1): the binder of a pixel spreads over a box around it, within its layer.
#pragma once

#include "slicer/effects/effect.h"

namespace binderjet {

EffectKind spread_kind();

}  // namespace binderjet
