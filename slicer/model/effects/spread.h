// SPDX-License-Identifier: GPL-3.0-or-later
// Binder spread (paper, 4.1): the binder of a pixel spreads around it, within its layer.
//
//   shape = "box" | "gaussian", width_mm = [x, y]: the box's width, or the full width at half the
//   gaussian's height, so that both widths are what an eye would call the width.
#pragma once

#include "slicer/model/effects/effect.h"

namespace binderjet {

EffectKind spread_kind();

}  // namespace binderjet
