// SPDX-License-Identifier: GPL-3.0-or-later
// The examples that the kinds of effects give of themselves, for tests that go over all of them.
#pragma once

#include <algorithm>
#include <vector>

#include "slicer/model/effects/catalogue.h"
#include "slicer/model/effects/level.h"

namespace binderjet::whole {

// Where the examples show: a part of 3 x 2 mm.
inline const Grid kExampleGrid{{0.1, 0.08, 0.1}, {2, 2, 2}};
inline const JobPlace kExamplePlace{{3, 5}, {3, 1.92}};

inline bool has_level(const EffectSpec& effect) { return level_place({effect}) == 0; }

// A whole model with this effect, which may itself say the level.
inline EffectList model_with_example(const EffectSpec& effect) {
  EffectList model{{"spread", {{"shape", "box"}}, {{"width_mm", {0.5, 0.3}}}}};
  if (!has_level(effect)) model.push_back({"threshold", {}, {{"level", {0.5}}}});
  model.push_back(effect);
  return model;
}

// Those that stand beside a level.
inline std::vector<EffectSpec> examples_beside_a_level() {
  std::vector<EffectSpec> out;
  for (const EffectKind& kind : effect_kinds()) {
    std::copy_if(kind.examples.begin(), kind.examples.end(), std::back_inserter(out),
                 [](const EffectSpec& effect) { return !has_level(effect); });
  }
  return out;
}

}  // namespace binderjet::whole
