// SPDX-License-Identifier: GPL-3.0-or-later
// Fill: powder is bound where its dose reaches the fill level, whether or not it can stand alone.
//
//   level: the least dose that binds powder, above 0, at most 1; 1 is the dose within a wide solid
//
// The paper's one threshold stands for two things, that holes fill and that tiny parts are eroded
// (its section 3); no level gives both. Fill is the first of them, survive the second.
#include "slicer/model/effects/assembled_model.h"

namespace binderjet {

EffectKind fill_effect() {
  return {.name = "fill",
          .numbers = {{.name = "level",
                       .min = 0,
                       .max = 1,
                       .role = NumberRole::kLevel,
                       .drift_step = kLevelDrift,
                       .fit_step = 0.005}},
          .write_into = [](const EffectSpec& spec, const Grid&,
                           AssembledModel& form) { form.bind_at(spec.number("level")); },
          .examples = {{"fill", {}, {{"level", {0.375}}}}},
          .not_sought = "its level is the model's, for which there is one candidate already"};
}

}  // namespace binderjet
