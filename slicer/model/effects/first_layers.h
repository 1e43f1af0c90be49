// SPDX-License-Identifier: GPL-3.0-or-later
// First layers: on the bed's bottom there is no dry powder to draw binder down, so it stays.
//
//   amount, height_mm: the dose is multiplied by 1 + amount exp(-z / height_mm)
#pragma once

#include "slicer/model/effects/effect.h"

namespace binderjet {

EffectKind first_layers_kind();

}  // namespace binderjet
