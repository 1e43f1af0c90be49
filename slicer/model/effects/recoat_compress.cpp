// SPDX-License-Identifier: GPL-3.0-or-later
// Compression: the roller presses the layers below it, so the print is lower than it was sent.
//
//   share: of the height, above -0.2, at most 0.2; negative: the print is higher. No layer is moved
//   by more than kMaxLayers.
#include <algorithm>
#include <cmath>

#include "slicer/model/effects/assembled_model.h"
#include "slicer/model/effects/candidates.h"

namespace binderjet {
namespace {

constexpr int kMaxLayers = 8;  // what a stream holds of the job on each side
constexpr double kMaxShare = 0.2;

void write_into(const EffectSpec& spec, const Grid&, AssembledModel& form) {
  const double share = spec.number("share");
  // At the middle of printed layer k lies what was meant for (k + 1/2) / (1 - share).
  const double lower = share / (1 - share);
  form.moves.push_back({[lower](int layer) {
                          const int by =
                              static_cast<int>(std::floor((layer + 0.5) * (1 + lower))) - layer;
                          return std::clamp(by, -kMaxLayers, kMaxLayers);
                        },
                        kMaxLayers});
}

EffectSpec effect(double share) { return {"recoat_compress", {}, {{"share", {share}}}}; }

// Shares that move the top by half a layer more each.
void add_trials(TrialList& list) {
  const int top = list.job.first_layer + list.job.layers;
  for (int halves = -2 * kMaxMovedLayers; halves <= 2 * kMaxMovedLayers; ++halves) {
    const double share = halves / 2.0 / top;
    if (halves == 0 || std::abs(share) > kMaxShare) continue;
    list.orders.push_back(
        {effect(share), {Covariate::Axis::kZ, Covariate::Form::kTrend}, [share](int layer) {
           return static_cast<int>(std::floor((layer + 0.5) / (1 - share))) - layer;
         }});
  }
}

}  // namespace

EffectKind recoat_compress_effect() {
  return {
      .name = "recoat_compress",
      .numbers = {{.name = "share", .min = -kMaxShare, .max = kMaxShare, .search_step = one_tenth}},
      .write_into = write_into,
      .examples = {effect(0.15)},
      .once = true,
      .add_trials = add_trials};
}

}  // namespace binderjet
