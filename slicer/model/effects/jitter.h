// SPDX-License-Identifier: GPL-3.0-or-later
// Jitter: each layer lands at random beside its place. No mask can make that good, and the print to
// expect is the one without it; the profile keeps how far, for who judges a print.
//
//   sigma_mm = [x, y]: standard deviation
#pragma once

#include "slicer/model/effects/effect.h"

namespace binderjet {

EffectKind jitter_kind();

}  // namespace binderjet
