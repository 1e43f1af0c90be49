// SPDX-License-Identifier: GPL-3.0-or-later
// An effect of the printer model as data: its kind, its parameters, its forward form.
//
// Adding an effect touches: one file here with its EffectKind, one line in effect.cpp's list, its
// tests. Profiles, simulate, enhance and calibrate find it through that list.
#pragma once

#include <array>
#include <map>
#include <string>
#include <vector>

#include "slicer/layers/grid.h"

namespace binderjet {

// One effect of a profile: the kind and its parameters by name.
struct EffectSpec {
  std::string kind;
  std::map<std::string, std::string> words;
  std::map<std::string, std::vector<double>> numbers;

  double number(const std::string& name, std::size_t index = 0) const {
    return numbers.at(name).at(index);
  }
  // For an optional parameter.
  double number_or(const std::string& name, double otherwise) const {
    const auto found = numbers.find(name);
    return found == numbers.end() ? otherwise : found->second.front();
  }
};

// The effects of a printer model, in the order in which they act.
using EffectList = std::vector<EffectSpec>;

// How far from a voxel masks still matter for it: voxels in x and y, layers in z.
struct Reach {
  std::array<int, 2> xy_vx{};
  int layers_below = 0;
  int layers_above = 0;
};

struct NumberRule {
  std::string name;
  std::size_t count;  // how many numbers the parameter has
  double min;         // allowed: min < value <= max
  double max;
  // How far a real printer may be off the profile, by a share of the value and by a step: the
  // process window (slicer/model/process_window.h).
  double drift_share = 0;
  double drift_step = 0;
  bool optional = false;
};
struct WordRule {
  std::string name;
  std::vector<std::string> allowed;
};

// How far the level of a real printer may be off, as dose.
constexpr double kLevelDrift = 0.05;

struct AssembledModel;  // assembled_model.h

struct EffectKind {
  std::string kind;
  std::vector<WordRule> words;
  std::vector<NumberRule> numbers;
  // The forward form: writes the effect into the model, which knows from there how far it reaches.
  // Error{kBadInput} if it does not fit there.
  void (*add)(const EffectSpec&, const Grid&, AssembledModel&);
};

const std::vector<EffectKind>& effect_kinds();
const EffectKind* find_effect_kind(const std::string& kind);  // null if there is none

// What is wrong with a spec, and in which key ("" is the kind itself); empty `what` if nothing is.
struct SpecFault {
  std::string key;
  std::string what;
};
SpecFault check_effect(const EffectSpec& spec);

}  // namespace binderjet
