// SPDX-License-Identifier: GPL-3.0-or-later
// Lost layers: from one height on all features lie lower than they were sent, since layers were
// lost or powder was short; or higher, since layers came twice.
//
//   at_mm: the height in the print, from 0 on
//   layers: how many are lost there, at most 8; negative: so many came twice, at most 8
#include <cmath>

#include "slicer/model/effects/assembled_model.h"
#include "slicer/model/effects/candidates.h"

namespace binderjet {
namespace {

constexpr int kMaxLayers = 8;  // what a stream holds of the job on each side

void write_into(const EffectSpec& spec, const Grid& grid, AssembledModel& form) {
  const int from = static_cast<int>(std::lround(spec.number("at_mm") / grid.pitch_mm[2]));
  const int by = static_cast<int>(std::lround(spec.number("layers")));
  form.moves.push_back({[from, by](int layer) { return layer >= from ? by : 0; }, std::abs(by)});
}

EffectSpec effect(double at_mm, double layers) {
  return {"slice_dropout", {}, {{"at_mm", {at_mm}}, {"layers", {layers}}}};
}

void add_trials(TrialList& list) {
  const JobExtent& job = list.job;
  for (int k = 1; k < job.layers; ++k) {
    const int from = job.first_layer + k;
    const double at_mm = job.layer_mm(from);
    for (const int by : {-2, -1, 1, 2}) {
      list.orders.push_back({effect(at_mm, by),
                             {Covariate::Axis::kZ, Covariate::Form::kStep, {{"at_mm", {at_mm}}}},
                             [from, by](int layer) { return layer >= from ? by : 0; }});
    }
  }
}

}  // namespace

EffectKind slice_dropout_effect() {
  return {.name = "slice_dropout",
          .numbers = {{.name = "at_mm", .min = -1e-9, .max = 1000, .search_step = one_layer},
                      {.name = "layers", .min = -kMaxLayers - 1e-9, .max = kMaxLayers}},
          .write_into = write_into,
          .examples = {effect(0.2, 1)},
          .add_trials = add_trials};
}

}  // namespace binderjet
