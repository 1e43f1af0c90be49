// SPDX-License-Identifier: GPL-3.0-or-later
// Lost layers: from one height on all features lie lower than they were sent, since layers were
// lost or powder was short; or higher, since layers came twice.
//
//   at_mm: the height in the print; layers: how many are lost there, negative: doubled
#pragma once

#include "slicer/model/effects/effect.h"

namespace binderjet {

EffectKind slice_dropout_kind();

}  // namespace binderjet
