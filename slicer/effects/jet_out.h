// SPDX-License-Identifier: GPL-3.0-or-later
// Weak jets: a row of the head gives less binder, along all of the fast axis.
//
//   from_mm, to_mm: the row's place on the bed along y; amount: the dose there is multiplied by
//   1 + amount
#pragma once

#include "slicer/effects/effect.h"

namespace binderjet {

EffectKind jet_out_kind();

}  // namespace binderjet
