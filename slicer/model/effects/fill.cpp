// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/model/effects/fill.h"

#include "slicer/model/effects/assembled_model.h"

namespace binderjet {

EffectKind fill_kind() {
  return {"fill",
          {},
          {{"level", 1, 0, 1, 0, kLevelDrift}},
          [](const EffectSpec& spec, const Grid&, AssembledModel& form) {
            form.bind_at(spec.number("level"));
          }};
}

}  // namespace binderjet
