// SPDX-License-Identifier: GPL-3.0-or-later
// Threshold (paper, 4.1): a voxel is printed iff its dose reaches the level.
#pragma once

#include "slicer/model/effects/effect.h"

namespace binderjet {

EffectKind threshold_kind();

}  // namespace binderjet
