// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/model/process_window.h"

#include <algorithm>
#include <utility>

#include "slicer/model/effects/catalogue.h"

namespace binderjet {
namespace {

// The effect with all its parameters that drift moved to one end; false if none does.
bool drift(EffectSpec& effect, int direction) {
  bool any = false;
  for (const NumberRule& rule : find_effect_kind(effect.kind)->numbers) {
    if (rule.drift_share == 0 && rule.drift_step == 0) continue;
    any = true;
    for (double& value : effect.numbers.at(rule.name)) {
      const double moved = value * (1 + direction * rule.drift_share) + direction * rule.drift_step;
      // What the window would push out of the parameter's range stays where it is.
      if (moved > rule.min && moved <= rule.max) value = moved;
    }
  }
  return any;
}

}  // namespace

std::vector<PrinterModel> process_window(const std::vector<EffectSpec>& effects, const Grid& grid,
                                         const JobPlace& place) {
  std::vector<std::vector<EffectSpec>> corners{effects};
  for (std::size_t e = 0; e < effects.size(); ++e) {
    std::vector<std::vector<EffectSpec>> next;
    for (const std::vector<EffectSpec>& corner : corners) {
      for (const int direction : {-1, 1}) {
        std::vector<EffectSpec> moved = corner;
        if (drift(moved[e], direction)) next.push_back(std::move(moved));
      }
    }
    if (!next.empty()) corners = std::move(next);
  }
  std::vector<PrinterModel> models{PrinterModel(effects, grid, place)};
  if (corners.size() == 1) return models;
  for (const std::vector<EffectSpec>& corner : corners) models.emplace_back(corner, grid, place);
  return models;
}

}  // namespace binderjet
