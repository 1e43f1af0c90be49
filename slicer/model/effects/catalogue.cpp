// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/model/effects/catalogue.h"

#include <fmt/format.h>

#include <algorithm>

// One line for each effect, in the order in which messages list them: it declares the function that
// KIND.cpp defines, and lists the kind.
// clang-format off
#define BINDERJET_EFFECTS(EFFECT) \
  EFFECT(spread)                  \
  EFFECT(threshold)               \
  EFFECT(fill)                    \
  EFFECT(survive)                 \
  EFFECT(tail)                    \
  EFFECT(rounding)                \
  EFFECT(z_bleed_down)            \
  EFFECT(z_wick_up)               \
  EFFECT(density)                 \
  EFFECT(shift)                   \
  EFFECT(registration_drift)      \
  EFFECT(layer_shift_low)         \
  EFFECT(parity)                  \
  EFFECT(jitter)                  \
  EFFECT(scale_xyz)               \
  EFFECT(grad_bed)                \
  EFFECT(grad_z)                  \
  EFFECT(pause)                   \
  EFFECT(first_layers)            \
  EFFECT(band_swath)              \
  EFFECT(jet_out)                 \
  EFFECT(recoat_streak)           \
  EFFECT(first_drops)             \
  EFFECT(slice_dropout)           \
  EFFECT(recoat_compress)         \
  EFFECT(infiltrant)              \
  EFFECT(empirical)
// clang-format on

namespace binderjet {

#define DECLARE(name) EffectKind name##_effect();
BINDERJET_EFFECTS(DECLARE)
#undef DECLARE

namespace {

std::string known_kinds() {
  std::vector<std::string> kinds;
  for (const EffectKind& kind : effect_kinds()) kinds.push_back(kind.name);
  return fmt::format("{}", fmt::join(kinds, ", "));
}

template <class Rule>
const Rule* find_rule(const std::vector<Rule>& rules, const std::string& name) {
  const auto found =
      std::find_if(rules.begin(), rules.end(), [&](const Rule& r) { return r.name == name; });
  return found == rules.end() ? nullptr : &*found;
}

SpecFault check_word(const WordRule& rule, const EffectSpec& spec) {
  const auto found = spec.words.find(rule.name);
  if (found == spec.words.end()) {
    return {"",
            fmt::format("needs the key {}, one of: {}", rule.name, fmt::join(rule.allowed, ", "))};
  }
  if (std::find(rule.allowed.begin(), rule.allowed.end(), found->second) != rule.allowed.end()) {
    return {};
  }
  return {rule.name,
          fmt::format("\"{}\" is not one of: {}", found->second, fmt::join(rule.allowed, ", "))};
}

SpecFault check_numbers(const NumberRule& rule, const EffectSpec& spec) {
  const auto found = spec.numbers.find(rule.name);
  if (found == spec.numbers.end()) {
    return {"", rule.optional ? "" : fmt::format("needs the key {}", rule.name)};
  }
  if (found->second.size() != rule.count) {
    return {rule.name, fmt::format("needs {} number{}", rule.count, rule.count == 1 ? "" : "s")};
  }
  for (const double value : found->second) {
    if (!(value > rule.min && value <= rule.max)) {
      return {rule.name,
              fmt::format("{} is not above {} and at most {}", value, rule.min, rule.max)};
    }
  }
  return {};
}

}  // namespace

const std::vector<EffectKind>& effect_kinds() {
#define LIST(name) name##_effect(),
  static const std::vector<EffectKind> kinds = {BINDERJET_EFFECTS(LIST)};
#undef LIST
  return kinds;
}

const EffectKind* find_effect_kind(const std::string& name) {
  for (const EffectKind& known : effect_kinds()) {
    if (known.name == name) return &known;
  }
  return nullptr;
}

const std::string& nameless_word() {
  return std::find_if(effect_kinds().begin(), effect_kinds().end(),
                      [](const EffectKind& kind) { return kind.nameless; })
      ->name;
}

SpecFault check_effect(const EffectSpec& spec) {
  const EffectKind* kind = find_effect_kind(spec.kind);
  if (kind == nullptr) {
    return {"kind", fmt::format("there is no effect \"{}\"; known: {}", spec.kind, known_kinds())};
  }
  for (const auto& [name, value] : spec.words) {
    if (find_rule(kind->words, name) == nullptr) return {name, "unknown key for " + spec.kind};
  }
  for (const auto& [name, value] : spec.numbers) {
    if (find_rule(kind->numbers, name) == nullptr) return {name, "unknown key for " + spec.kind};
  }
  for (const WordRule& rule : kind->words) {
    if (SpecFault fault = check_word(rule, spec); !fault.what.empty()) return fault;
  }
  for (const NumberRule& rule : kind->numbers) {
    if (SpecFault fault = check_numbers(rule, spec); !fault.what.empty()) return fault;
  }
  return {};
}

}  // namespace binderjet
