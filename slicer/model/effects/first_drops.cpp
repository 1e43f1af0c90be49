// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/model/effects/first_drops.h"

#include <cmath>

#include "slicer/base/error.h"
#include "slicer/model/effects/assembled_model.h"

namespace binderjet {
namespace {

void add(const EffectSpec& spec, const Grid& grid, AssembledModel& form) {
  if (!form.placed.weak_drops.empty()) {
    throw Error(ErrorKind::kBadInput, "effects", "first_drops stands twice; keep one");
  }
  constexpr double kLeast = 0.004;  // weaker than that moves no edge
  const double amount = spec.number("amount");
  const double length = spec.number("length_mm");
  for (int pixel = 0;; ++pixel) {
    const double lacks = amount * std::exp(-(pixel + 0.5) * grid.pitch_mm[0] / length);
    if (std::abs(lacks) < kLeast) break;
    form.placed.weak_drops.push_back(lacks);
  }
  form.placed.weak_after_gaps = spec.words.at("after") == "gap";
}

}  // namespace

EffectKind first_drops_kind() {
  return {"first_drops",
          {{"after", {"line", "gap"}}},
          {{"amount", 1, -1, 1}, {"length_mm", 1, 0, 20}},
          add};
}

}  // namespace binderjet
