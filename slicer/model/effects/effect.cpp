// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/model/effects/effect.h"

#include <fmt/format.h>

#include <algorithm>

#include "slicer/model/effects/band_swath.h"
#include "slicer/model/effects/density.h"
#include "slicer/model/effects/empirical.h"
#include "slicer/model/effects/fill.h"
#include "slicer/model/effects/first_drops.h"
#include "slicer/model/effects/first_layers.h"
#include "slicer/model/effects/grad_bed.h"
#include "slicer/model/effects/grad_z.h"
#include "slicer/model/effects/infiltrant.h"
#include "slicer/model/effects/jet_out.h"
#include "slicer/model/effects/jitter.h"
#include "slicer/model/effects/layer_shift_low.h"
#include "slicer/model/effects/parity.h"
#include "slicer/model/effects/pause.h"
#include "slicer/model/effects/recoat_compress.h"
#include "slicer/model/effects/recoat_streak.h"
#include "slicer/model/effects/registration_drift.h"
#include "slicer/model/effects/rounding.h"
#include "slicer/model/effects/scale_xyz.h"
#include "slicer/model/effects/shift.h"
#include "slicer/model/effects/slice_dropout.h"
#include "slicer/model/effects/spread.h"
#include "slicer/model/effects/survive.h"
#include "slicer/model/effects/tail.h"
#include "slicer/model/effects/threshold.h"
#include "slicer/model/effects/z_bleed_down.h"
#include "slicer/model/effects/z_wick_up.h"

namespace binderjet {
namespace {

std::string known_kinds() {
  std::vector<std::string> kinds;
  for (const EffectKind& kind : effect_kinds()) kinds.push_back(kind.kind);
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
  static const std::vector<EffectKind> kinds = {
      spread_kind(),
      threshold_kind(),
      fill_kind(),
      survive_kind(),
      tail_kind(),
      rounding_kind(),
      z_bleed_down_kind(),
      z_wick_up_kind(),
      density_kind(),
      shift_kind(),
      registration_drift_kind(),
      layer_shift_low_kind(),
      parity_kind(),
      jitter_kind(),
      scale_xyz_kind(),
      grad_bed_kind(),
      grad_z_kind(),
      pause_kind(),
      first_layers_kind(),
      band_swath_kind(),
      jet_out_kind(),
      recoat_streak_kind(),
      first_drops_kind(),
      slice_dropout_kind(),
      recoat_compress_kind(),
      infiltrant_kind(),
      empirical_kind(),
  };
  return kinds;
}

const EffectKind* find_effect_kind(const std::string& kind) {
  for (const EffectKind& known : effect_kinds()) {
    if (known.kind == kind) return &known;
  }
  return nullptr;
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
