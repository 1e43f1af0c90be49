// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/effects/spread.h"

#include <cmath>

namespace binderjet {
namespace {

// The farthest voxel offset whose weight, the overlap of [i - 1/2, i + 1/2] with [-w/2, w/2], is
// not 0.
int box_reach_vx(double width_vx) {
  return static_cast<int>(std::ceil(width_vx / 2 + 0.5)) - 1;
}

Reach reach(const EffectSpec& spec, const Grid& grid) {
  Reach reach;
  for (int axis = 0; axis < 2; ++axis) {
    const double width_mm = spec.number("width_mm", static_cast<std::size_t>(axis));
    reach.xy_vx[axis] = box_reach_vx(width_mm / grid.voxel_mm(axis));
  }
  return reach;
}

}  // namespace

EffectKind spread_kind() {
  constexpr double kMaxWidthMm = 10;
  return {"spread", {{"shape", {"box"}}}, {{"width_mm", 2, 0, kMaxWidthMm}}, reach};
}

}  // namespace binderjet
