// SPDX-License-Identifier: GPL-3.0-or-later
// The printer model: the ordered effects of a profile on one voxel grid.
#pragma once

#include <vector>

#include "slicer/effects/effect.h"

namespace binderjet {

// How far the whole model reaches: the sum of its effects' reaches.
Reach model_reach(const std::vector<EffectSpec>& effects, const Grid& grid);

}  // namespace binderjet
