// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/model/effects/level.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "slicer/model/effects/catalogue.h"

namespace binderjet {
namespace {

// Null if effects of this kind do not bind.
const NumberRule* level_rule(const EffectKind& kind) {
  for (const NumberRule& rule : kind.numbers) {
    if (rule.role == NumberRole::kLevel) return &rule;
  }
  return nullptr;
}
const NumberRule* level_rule(const EffectSpec& effect) {
  return level_rule(*find_effect_kind(effect.kind));
}

}  // namespace

std::string kinds_with_level(const std::string& article) {
  std::vector<std::string> kinds;
  for (const EffectKind& kind : effect_kinds()) {
    if (level_rule(kind) != nullptr) kinds.push_back(article + kind.name);
  }
  return fmt::format("{}", fmt::join(kinds, " or "));
}

std::size_t level_place(const EffectList& model) {
  const auto found = std::find_if(model.begin(), model.end(), [](const EffectSpec& effect) {
    return level_rule(effect) != nullptr;
  });
  return static_cast<std::size_t>(found - model.begin());
}

double level_of(const EffectList& model) {
  const std::size_t place = level_place(model);
  return place == model.size() ? 0 : model[place].number(level_rule(model[place])->name);
}

EffectList with_level(EffectList model, double level) {
  // Below that a fit would say that anything binds.
  constexpr double kLeast = 0.02;
  const std::size_t place = level_place(model);
  if (place == model.size()) return model;
  model[place].numbers[level_rule(model[place])->name] = {std::clamp(level, kLeast, 1.0)};
  return model;
}

EffectList with_level_gain(EffectList model, double gain) {
  const double level = level_of(model) / std::max(0.2, 1 + gain);
  return with_level(std::move(model), level);
}

}  // namespace binderjet
