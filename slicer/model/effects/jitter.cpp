// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/model/effects/jitter.h"

#include "slicer/model/effects/assembled_model.h"

namespace binderjet {

EffectKind jitter_kind() {
  return {"jitter",
          {},
          {{"sigma_mm", 2, -1e-9, 5}},
          [](const EffectSpec&, const Grid&, AssembledModel&) {}};
}

}  // namespace binderjet
