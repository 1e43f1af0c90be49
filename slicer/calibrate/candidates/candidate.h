// SPDX-License-Identifier: GPL-3.0-or-later
// What could be missing from a model: each candidate as columns to regress the residual on, and as
// the effect that it becomes in the real forward model.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "slicer/calibrate/job/calibration.h"
#include "slicer/model/dose/placed_dose.h"

namespace binderjet {

// How a candidate changes the dose at a point of the surface, per unit of its coefficient.
struct Column {
  enum class Basis {
    kLevel,   // 1: the level falls
    kDose,    // the dose there: it is multiplied
    kShiftX,  // by how much the dose changes when the mask moves along x by 1 mm
    kShiftY,
    kModel,  // (dose of `nudged` - dose) / step: a finite difference of the forward model
  };
  Basis basis = Basis::kDose;
  std::function<double(const Spot&)> of;  // times this; empty: times 1
  EffectList nudged;
  double step = 1;
};

// Axes that a candidate varies along: folds must run along others.
enum Along : unsigned { kNowhere = 0, kAlongX = 1, kAlongY = 2, kAlongZ = 4 };

struct Candidate {
  std::string kind;  // for calibration.json
  Covariate covariate;
  std::vector<Column> columns;
  unsigned along = kNowhere;
  // The model with the effect, from the columns' coefficients; empty if those make no sense
  // (a negative share).
  std::function<EffectList(std::span<const double>)> apply;
  std::size_t effect = 0;  // its place among the effects of the model that apply() makes

  bool named() const { return kind != "empirical"; }
};

// Every effect of the catalogue that masks and stacks can show and the model does not have yet.
std::vector<Candidate> named_candidates(const MeasuredJob& job, const EffectList& model);

// The scan: what has no name, by what it depends on.
std::vector<Candidate> scan_candidates(const MeasuredJob& job, const EffectList& model);

// Helpers of both lists.
EffectList with_effect(EffectList model, EffectSpec effect);
// The dose times 1 + gain everywhere, said by the level.
EffectList with_level_gain(EffectList model, double gain);
const EffectSpec* find_effect(const EffectList& model, const std::string& kind);
// Frequencies, in turns per unit, from one turn over `extent` to one over `shortest`, as close as
// that extent can tell apart.
std::vector<double> frequencies(double extent, double shortest);

}  // namespace binderjet
