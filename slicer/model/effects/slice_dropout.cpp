// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/model/effects/slice_dropout.h"

#include <cmath>

#include "slicer/model/effects/assembled_model.h"

namespace binderjet {
namespace {

constexpr int kMostLayers = 8;  // what a stream holds of the job on each side

void add(const EffectSpec& spec, const Grid& grid, AssembledModel& form) {
  const int from = static_cast<int>(std::lround(spec.number("at_mm") / grid.pitch_mm[2]));
  const int by = static_cast<int>(std::lround(spec.number("layers")));
  form.moves.push_back({[from, by](int layer) { return layer >= from ? by : 0; }, std::abs(by)});
}

}  // namespace

EffectKind slice_dropout_kind() {
  return {"slice_dropout",
          {},
          {{"at_mm", 1, -1e-9, 1000}, {"layers", 1, -kMostLayers - 1e-9, kMostLayers}},
          add};
}

}  // namespace binderjet
