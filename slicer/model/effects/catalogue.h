// SPDX-License-Identifier: GPL-3.0-or-later
// The catalogue: all kinds of effects that a profile may name.
#pragma once

#include <string>
#include <vector>

#include "slicer/model/effects/effect.h"

namespace binderjet {

const std::vector<EffectKind>& effect_kinds();
// Null if there is none.
const EffectKind* find_effect_kind(const std::string& name);
// What calibration.json calls a finding that has no name: the kind that is nameless.
const std::string& nameless_word();

// What is wrong with a spec, and in which key ("" is the kind itself); empty `what` if nothing is.
struct SpecFault {
  std::string key;
  std::string what;
};
SpecFault check_effect(const EffectSpec& spec);

}  // namespace binderjet
