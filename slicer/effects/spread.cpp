// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/effects/spread.h"

#include "slicer/effects/model.h"

namespace binderjet {
namespace {

BoxWeights weights(const EffectSpec& spec, const Grid& grid, int axis) {
  return box_weights(spec.number("width_mm", static_cast<std::size_t>(axis)) / grid.voxel_mm(axis));
}

}  // namespace

EffectKind spread_kind() {
  constexpr double kMaxWidthMm = 10;
  return {"spread",
          {{"shape", {"box"}}},
          {{"width_mm", 2, 0, kMaxWidthMm}},
          [](const EffectSpec& spec, const Grid& grid) {
            return Reach{{weights(spec, grid, 0).reach, weights(spec, grid, 1).reach}, 0, 0};
          },
          [](const EffectSpec& spec, const Grid& grid, ModelForm& form) {
            form.spread_x = weights(spec, grid, 0);
            form.spread_y = weights(spec, grid, 1);
          }};
}

}  // namespace binderjet
