// SPDX-License-Identifier: GPL-3.0-or-later
// The level of a model, from which dose on powder is bound, whichever of its effects says so.
#pragma once

#include <string>

#include "slicer/model/effects/effect.h"

namespace binderjet {

// The kinds that can say so, for a message: "threshold or fill", or with "a " before each.
std::string kinds_with_level(const std::string& article = "");
// The place of the effect that has the level; model.size() if none has.
std::size_t level_place(const EffectList& model);
// 0 if no effect has it.
double level_of(const EffectList& model);
// The model with this level, within what a fit may say of it; the model as it is if none has.
EffectList with_level(EffectList model, double level);
// The dose times 1 + gain everywhere, said by the level.
EffectList with_level_gain(EffectList model, double gain);

}  // namespace binderjet
