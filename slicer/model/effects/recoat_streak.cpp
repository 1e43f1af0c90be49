// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/model/effects/recoat_streak.h"

#include <cmath>

#include "slicer/model/effects/assembled_model.h"

namespace binderjet {
namespace {

void add(const EffectSpec& spec, const Grid&, AssembledModel& form) {
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

}  // namespace

EffectKind recoat_streak_kind() {
  return {"recoat_streak",
          {{"across", {"x", "y"}}},
          {{"from_mm", 1, -1000, 1000},
           {"to_mm", 1, -1000, 1000},
           {"at_mm", 1, -1e-9, 1000},
           {"amount", 1, -1, 2}},
          add};
}

}  // namespace binderjet
