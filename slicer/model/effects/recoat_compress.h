// SPDX-License-Identifier: GPL-3.0-or-later
// Compression: the roller presses the layers below it, so the print is lower than it was sent.
//
//   share: of the height; negative: the print is higher. At most kMostLayers layers are made good.
#pragma once

#include "slicer/model/effects/effect.h"

namespace binderjet {

EffectKind recoat_compress_kind();

}  // namespace binderjet
