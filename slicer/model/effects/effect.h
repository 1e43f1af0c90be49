// SPDX-License-Identifier: GPL-3.0-or-later
// The contract of an effect: its numbers in a profile (EffectSpec), and what a kind of effect says
// of itself (EffectKind) so that no other code needs to know its name or its parameters.
//
// A kind is one file KIND.cpp beside this header, and one line in catalogue.cpp. The file says at
// its top what every parameter means, and defines one function, EffectKind KIND_effect(). Profiles,
// simulate, score, check and --enhance inverse need no more than `words`, `numbers` and `write_into`;
// calibrate finds and fits the effect by what stands below these (slicer/MODEL.md, "Effects" and
// "How calibrate chooses").
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
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
  // For a parameter of two numbers, along x and along y.
  std::array<double, 2> pair(const std::string& name) const {
    return {number(name, 0), number(name, 1)};
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

// What a number is to code that knows no parameter by its name.
enum class NumberRole {
  kOther,
  kLevel,  // the dose from which on powder is bound (level.h)
};

// One parameter of numbers: what a profile may say, how far a printer may be off it, how it is
// fitted.
struct NumberRule {
  std::string name{};
  std::size_t count = 1;  // how many numbers the parameter has
  double min = 0;         // allowed: min < value <= max, so -1e-9 where 0 is allowed
  double max = 0;
  bool optional = false;
  NumberRole role = NumberRole::kOther;
  // How far a real printer may be off the profile, by a share of the value and by a step: the
  // process window (slicer/model/process_window.h).
  double drift_share = 0;
  double drift_step = 0;
  // A fit moves the number by steps of `fit_step + fit_share * value`, a move that a print shows
  // and over which the dose is still nearly linear. 0 where a fit leaves the number alone: it names
  // a place or a choice, or moves no dose.
  double fit_step = 0;
  double fit_share = 0;
  // Null: always. Else whether a fit may move the number where it has this value in this effect.
  bool (*fits)(const EffectSpec&, double value) = nullptr;
  // A number that names a place or a size has no slope that a fit could follow, so it is searched:
  // moved by steps of this while the print gets better. Null, or 0: not searched.
  double (*search_step)(const EffectSpec&, double value, const Grid&) = nullptr;
};

// The search steps that most places and sizes have.
inline double one_layer(const EffectSpec&, double, const Grid& grid) { return grid.pitch_mm[2]; }
inline double one_voxel_y(const EffectSpec&, double, const Grid& grid) { return grid.voxel_mm(1); }
inline double one_tenth(const EffectSpec&, double value, const Grid&) {
  return 0.1 * std::abs(value);
}

struct WordRule {
  std::string name;
  std::vector<std::string> allowed;
};

// How far the level of a real printer may be off, as dose.
constexpr double kLevelDrift = 0.05;

// A term in the error of lengths that a caliper read (slicer/calibrate/gauges/gauge_lengths.h).
enum class LengthTerm {
  kOffset,      // every part larger by the same length
  kScale,       // every part larger by the same share
  kLayerShift,  // blocks off by which layer they lie in
  kBedPlace,    // off by the place on the bed
};
// A kind that would cause the term. One kind for each term is named; the others are its rivals.
struct LengthCause {
  LengthTerm term;
  bool named = true;
};

struct AssembledModel;  // assembled_model.h
class CandidateList;    // candidates.h
struct Covariate;       // covariate.h
struct GaugeChange;     // candidates.h
struct TrialList;       // candidates.h

struct EffectKind {
  std::string name{};
  std::vector<WordRule> words{};
  std::vector<NumberRule> numbers{};
  // Of a parameter that the kind has.
  const NumberRule& rule(const std::string& parameter) const {
    return *std::find_if(numbers.begin(), numbers.end(),
                         [&](const NumberRule& rule) { return rule.name == parameter; });
  }

  // The forward form: writes the effect into the model, which knows from there how far it reaches.
  // Error{kBadInput} if it does not fit there.
  void (*write_into)(const EffectSpec&, const Grid&, AssembledModel&) = nullptr;
  // At least one, and one for each word that changes the forward form, with numbers that show on a
  // part of 3 x 2 mm whose lower corner is at (3, 5) on the bed. Tests go over all of them.
  std::vector<EffectSpec> examples{};

  // Below is for calibrate, which asks nothing else of a kind.
  bool once = false;  // a model that has one gets no second
  // A dependence that was measured and has no mechanism: its finding is no name.
  bool nameless = false;
  // Adds what the residual in dose is regressed on (Candidate).
  void (*add_candidates)(CandidateList&) = nullptr;
  // Adds what moves no dose and is tried in the forward model itself.
  void (*add_trials)(TrialList&) = nullptr;
  // The effect of layers that land at random, with these standard deviations.
  EffectSpec (*random_layers)(const std::array<double, 2>& sigma_mm) = nullptr;
  // Adds changes of a declared model that slots and walls of a gauge may ask for.
  void (*add_gauge_changes)(const EffectList& declared, std::vector<GaugeChange>&) = nullptr;
  std::vector<LengthCause> length_causes{};
  // Brings the figures of a covariate that the fit has moved (a period) up to date. Null: none.
  void (*update_covariate)(const EffectSpec& fitted, Covariate&) = nullptr;
  // Why calibrate does not look for this kind; empty where it does.
  std::string not_sought{};
};

}  // namespace binderjet
