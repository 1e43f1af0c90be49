// SPDX-License-Identifier: GPL-3.0-or-later
// Streak: a chip on the roller or the blade leaves a line of other powder, from one height on.
//
//   across = "x" | "y": the axis that the line crosses
//   from_mm, to_mm: the line's place on the bed along that axis
//   at_mm: the height from which on it is there, from 0 on
//   amount: the dose in the line is multiplied by 1 + amount; above -1, at most 2
#include <algorithm>
#include <cmath>

#include "slicer/model/effects/assembled_model.h"
#include "slicer/model/effects/candidates.h"

namespace binderjet {
namespace {

void write_into(const EffectSpec& spec, const Grid&, AssembledModel& form) {
  const bool across_x = spec.words.at("across") == "x";
  const double from = spec.number("from_mm");
  const double to = spec.number("to_mm");
  const double at = spec.number("at_mm");
  const double amount = spec.number("amount");
  form.placed.gains.push_back({[=](const Spot& spot) {
                                 const double place = across_x ? spot.x_mm : spot.y_mm;
                                 const bool here = place >= from && place < to && spot.z_mm >= at;
                                 return here ? amount : 0;
                               },
                               std::abs(amount)});
}

EffectSpec effect(const std::string& across, double from_mm, double to_mm, double at_mm,
                  double amount) {
  return {"recoat_streak",
          {{"across", across}},
          {{"from_mm", {from_mm}}, {"to_mm", {to_mm}}, {"at_mm", {at_mm}}, {"amount", {amount}}}};
}

void add_candidates(CandidateList& list) {
  const JobExtent& job = list.job();
  for (std::size_t axis = 0; axis < 2; ++axis) {
    const std::string across = axis == 0 ? "x" : "y";
    const double end = job.place.origin_mm[axis] + job.place.size_mm[axis];
    for (const double width : {0.3, 0.6, 1.2}) {
      for (double from = job.place.origin_mm[axis]; from + width <= end; from += width / 2) {
        // Where a streak begins is found to a layer by the search.
        for (int fifth = 1; fifth < 5; ++fifth) {
          const double to = from + width;
          const double at = job.layer_mm(job.first_layer + fifth * job.layers / 5);
          list.add_effect({axis == 0 ? Covariate::Axis::kX : Covariate::Axis::kY,
                           Covariate::Form::kWindow,
                           {{"from_mm", {from}}, {"to_mm", {to}}}},
                          {dose_column([axis, from, to, at](const Spot& s) {
                            const double place = axis == 0 ? s.x_mm : s.y_mm;
                            return place >= from && place < to && s.z_mm >= at ? 1.0 : 0.0;
                          })},
                          (axis == 0 ? kAlongX : kAlongY) | kAlongZ,
                          [across, from, to, at](Coefficients c) {
                            return effect(across, from, to, at, std::clamp(c[0], -0.99, 1.9));
                          });
        }
      }
    }
  }
}

double one_voxel_across(const EffectSpec& spec, double, const Grid& grid) {
  return grid.voxel_mm(spec.words.at("across") == "x" ? 0 : 1);
}

}  // namespace

EffectKind recoat_streak_effect() {
  return {
      .name = "recoat_streak",
      .words = {{"across", {"x", "y"}}},
      .numbers = {{.name = "from_mm", .min = -1000, .max = 1000, .search_step = one_voxel_across},
                  {.name = "to_mm", .min = -1000, .max = 1000, .search_step = one_voxel_across},
                  {.name = "at_mm", .min = -1e-9, .max = 1000, .search_step = one_layer},
                  {.name = "amount", .min = -1, .max = 2, .fit_step = 0.005}},
      .write_into = write_into,
      .examples = {effect("y", 5.8, 6.2, 0.2, -0.5), effect("x", 4.3, 4.8, 0.3, -0.6)},
      .add_candidates = add_candidates};
}

}  // namespace binderjet
