// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/model/effects/spread.h"

#include "slicer/model/effects/assembled_model.h"

namespace binderjet {
namespace {

Kernel kernel(const EffectSpec& spec, const Grid& grid, int axis) {
  const double width_vx =
      spec.number("width_mm", static_cast<std::size_t>(axis)) / grid.voxel_mm(axis);
  return spec.words.at("shape") == "box" ? box_kernel(box_weights(width_vx))
                                         : gaussian_kernel(width_vx);
}

}  // namespace

EffectKind spread_kind() {
  constexpr double kMaxWidthMm = 10;
  constexpr double kDriftShare = 0.1;
  return {"spread",
          {{"shape", {"box", "gaussian"}}},
          {{"width_mm", 2, 0, kMaxWidthMm, kDriftShare, 0}},
          [](const EffectSpec& spec, const Grid& grid, AssembledModel& form) {
            for (DoseTerm& term : form.terms) {
              term.x = kernel(spec, grid, 0);
              term.y = kernel(spec, grid, 1);
            }
          }};
}

}  // namespace binderjet
