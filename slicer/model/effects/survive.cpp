// SPDX-License-Identifier: GPL-3.0-or-later
// Survive (paper, section 3): bound powder that is too thin is brushed off in the cleaning.
//
//   width_mm = [x, y]: what is thinner than this along x or y, within its layer, does not survive;
//   above 0, at most 10
//
// In whole voxels: each layer keeps the union of all boxes of that size that fit into what is bound
// (morphological opening). It comes before all other wear.
#include "slicer/model/effects/assembled_model.h"
#include "slicer/model/effects/candidates.h"
#include "slicer/model/wear/opening.h"

namespace binderjet {
namespace {

constexpr double kMaxMm = 10;

void write_into(const EffectSpec& spec, const Grid& grid, AssembledModel& form) {
  const std::array<int, 2> box{pixels_for(spec.number("width_mm", 0), grid.voxel_mm(0)),
                               pixels_for(spec.number("width_mm", 1), grid.voxel_mm(1))};
  form.wear_first({{{box[0] - 1, box[1] - 1}},
                   [box](const RunWindow& window) { return opening(window.middle(), box); }});
}

void add_trials(TrialList& list) {
  for (const double width_mm : {0.25, 0.5}) {
    list.wears.push_back({{"survive", {}, {{"width_mm", {width_mm, width_mm}}}},
                          {Covariate::Axis::kDensity, Covariate::Form::kLocal}});
  }
}

}  // namespace

EffectKind survive_effect() {
  return {.name = "survive",
          .numbers =
              {{.name = "width_mm", .count = 2, .min = 0, .max = kMaxMm, .search_step = one_tenth}},
          .write_into = write_into,
          .examples = {{"survive", {}, {{"width_mm", {0.5, 0.35}}}}},
          .once = true,
          .add_trials = add_trials};
}

}  // namespace binderjet
