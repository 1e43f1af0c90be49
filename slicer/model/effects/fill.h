// SPDX-License-Identifier: GPL-3.0-or-later
// Fill: powder is bound where its dose reaches the fill level, whether or not it can stand alone.
//
//   level: the least dose that binds powder, 0 to 1
//
// The paper's one threshold stands for two things, that holes fill and that tiny parts are eroded
// (its section 3); no level gives both. Fill is the first of them, survive the second.
#pragma once

#include "slicer/model/effects/effect.h"

namespace binderjet {

EffectKind fill_kind();

}  // namespace binderjet
