// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/model/effects/recoat_compress.h"

#include <algorithm>
#include <cmath>

#include "slicer/model/effects/assembled_model.h"

namespace binderjet {
namespace {

constexpr int kMostLayers = 8;  // what a stream holds of the job on each side

void add(const EffectSpec& spec, const Grid&, AssembledModel& form) {
  const double share = spec.number("share");
  // At the middle of printed layer k lies what was meant for (k + 1/2) / (1 - share).
  const double lower = share / (1 - share);
  form.moves.push_back({[lower](int layer) {
                          const int by =
                              static_cast<int>(std::floor((layer + 0.5) * (1 + lower))) - layer;
                          return std::clamp(by, -kMostLayers, kMostLayers);
                        },
                        kMostLayers});
}

}  // namespace

EffectKind recoat_compress_kind() {
  return {"recoat_compress", {}, {{"share", 1, -0.2, 0.2}}, add};
}

}  // namespace binderjet
