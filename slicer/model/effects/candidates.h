// SPDX-License-Identifier: GPL-3.0-or-later
// What could be missing from a model, as the kinds of effects offer it to calibrate: candidates as
// columns that the residual in dose is regressed on, trials in the forward model for what moves no
// dose, and changes of a number that a gauge may ask for (slicer/MODEL.md, "How calibrate
// chooses").
#pragma once

#include <functional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "slicer/model/dose/bed_dependence.h"
#include "slicer/model/effects/covariate.h"
#include "slicer/model/effects/effect.h"
#include "slicer/model/effects/job_extent.h"

namespace binderjet {

using Coefficients = std::span<const double>;

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
  std::function<double(const Spot&)> of{};  // times this; empty: times 1
  EffectList nudged{};
  double step = 1;
};
// The dose times 1 + coefficient * of(spot), and the mask shifted by coefficient * of(spot).
inline Column dose_column(std::function<double(const Spot&)> of = {}) {
  return {.basis = Column::Basis::kDose, .of = std::move(of)};
}
inline Column shift_column(std::size_t axis, std::function<double(const Spot&)> of = {}) {
  return {.basis = axis == 0 ? Column::Basis::kShiftX : Column::Basis::kShiftY,
          .of = std::move(of)};
}

// Axes that a candidate varies along: folds must run along others.
enum Along : unsigned { kNowhere = 0, kAlongX = 1, kAlongY = 2, kAlongZ = 4 };

struct Candidate {
  std::string kind{};  // for calibration.json
  bool named = true;   // false: no mechanism, so it explains nothing
  Covariate covariate{};
  std::vector<Column> columns{};
  unsigned along = kNowhere;
  // The model with the effect, from the columns' coefficients; empty if those make no sense
  // (a negative share).
  std::function<EffectList(Coefficients)> apply{};
  std::size_t effect = 0;  // its place among the effects of the model that apply() makes
  // A step or a window is out where nearly all points are on one side, since these say nothing of
  // its place. True where the place is given: what dies away from the bed on.
  bool has_given_place = false;
};

// The candidates of one kind after the other.
class CandidateList {
 public:
  // Both must outlive the list.
  CandidateList(const JobExtent& job, const EffectList& model) : job_(job), model_(model) {}

  // Lets a kind add its candidates.
  void ask(const EffectKind& kind);
  std::vector<Candidate> take() { return std::move(out_); }

  const JobExtent& job() const { return job_; }
  const EffectList& model() const { return model_; }
  // An effect of the kind that is asked.
  EffectSpec effect(std::map<std::string, std::string> words,
                    std::map<std::string, std::vector<double>> numbers) const;
  // The place of the model's effect of that kind; model().size() if there is none.
  std::size_t own_place() const;

  // A candidate that becomes a further effect of the model. The reference is valid until the next.
  Candidate& add(Covariate covariate, std::vector<Column> columns, unsigned along,
                 std::function<EffectList(Coefficients)> apply);
  Candidate& add_effect(Covariate covariate, std::vector<Column> columns, unsigned along,
                        const std::function<EffectSpec(Coefficients)>& effect);
  // An effect whose parameter goes from 0: its column is the forward model's own difference. It
  // makes no sense below `least` and above `most`.
  Candidate& add_from_zero(Covariate covariate, double step,
                           const std::function<EffectSpec(double)>& effect, double least,
                           double most);

 private:
  const JobExtent& job_;
  const EffectList& model_;
  const EffectKind* kind_ = nullptr;
  std::vector<Candidate> out_;
};
// The candidates of all kinds, in the order of the catalogue.
std::vector<Candidate> all_candidates(const JobExtent& job, const EffectList& model);

// Layer k of the print is what the model makes of layer k + by(k): all of these need no more prints
// than the layers' own, moved by at most kMaxMovedLayers.
constexpr int kMaxMovedLayers = 3;
struct OrderTrial {
  EffectSpec effect;
  Covariate covariate;
  std::function<int(int layer)> by;  // by the number of the layer in its job
};
// What happens to the part when it is dug out: done to what the model prints.
struct WearTrial {
  EffectSpec effect;
  Covariate covariate;
};
struct TrialList {
  JobExtent job;
  std::vector<OrderTrial> orders;
  std::vector<WearTrial> wears;
};
TrialList all_trials(const JobExtent& job, const EffectList& model);

// A number of a declared model that a gauge may show to be wrong.
struct GaugeChange {
  std::string kind;            // for calibration.json
  std::vector<double> values;  // to be tried, ascending
  std::function<EffectList(double value)> with;
  std::function<std::string(double value)> text;
  int numbers = 1;  // how many of the profile it changes
};
std::vector<GaugeChange> all_gauge_changes(const EffectList& declared);
// `count` values from `from` to `to`.
std::vector<double> evenly(double from, double to, int count);

// Null if the model has none of that kind.
const EffectSpec* find_effect(const EffectList& model, const std::string& kind);
EffectList with_effect(EffectList model, EffectSpec effect);
// Frequencies, in turns per unit, from one turn over `extent` to one over `shortest`, as close as
// that extent can tell apart.
std::vector<double> frequencies(double extent, double shortest);

}  // namespace binderjet
