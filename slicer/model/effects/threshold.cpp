// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/model/effects/threshold.h"

#include "slicer/model/effects/assembled_model.h"

namespace binderjet {

EffectKind threshold_kind() {
  return {"threshold",
          {},
          {{"level", 1, 0, 1, 0, kLevelDrift}},
          [](const EffectSpec& spec, const Grid&, AssembledModel& form) {
            form.bind_at(spec.number("level"));
          }};
}

}  // namespace binderjet
