// SPDX-License-Identifier: GPL-3.0-or-later
// The loop: look for what is missing, put it into the model, fit, until nothing more is found.
#pragma once

#include <string>
#include <vector>

#include "slicer/calibrate/calibrate.h"
#include "slicer/calibrate/choice/fit.h"
#include "slicer/calibrate/choice/forward_trials.h"
#include "slicer/calibrate/choice/rank_candidates.h"
#include "slicer/calibrate/residual/printed_error.h"

namespace binderjet {

class Calibrator {
 public:
  // `job` must outlive it.
  Calibrator(const MeasuredJob& job, const EffectList& declared, const CalibrationLimits& limits);

  void run();

  const EffectList& model() const { return model_; }
  const LayerChoice& held_out() const { return held_; }
  // What the residual that is left depends on most; none if that was not looked at.
  const std::optional<Remaining>& remaining() const { return remaining_; }
  std::vector<FoundEffect> effects() const;

 private:
  // An effect that is in the model now, and where its numbers are there.
  struct AcceptedEffect {
    FoundEffect found;
    std::size_t effect = 0;
    unsigned along = kNowhere;
  };
  // wrong_share() of the layers held out and of all.
  struct Errors {
    double held;
    double all;
  };
  // A candidate in the real forward model.
  struct FittedCandidate {
    Candidate candidate;
    EffectList model;
    double p = 1;
    double share = 0;
    bool equal = false;  // the regression cannot tell it from the best
    WrongCounts counts;  // of the layers seen
  };

  std::vector<FreeNumber> numbers_of_accepted() const;
  std::vector<std::vector<float>> known_columns(const std::vector<SurfacePoint>& points) const;
  bool add_one();
  std::vector<FittedCandidate> fit_ranked_candidates();
  std::vector<FittedCandidate> fit_ranked_trials();
  bool accept_best(std::vector<FittedCandidate> fitted);
  std::vector<std::string> rivals_of(const std::vector<FittedCandidate>& fitted,
                                     std::size_t best) const;
  EffectList refit_with_accepted(const EffectList& model, std::size_t effect, int rounds) const;
  WrongCounts counts_of(const EffectList& model) const;
  Errors errors_of(const EffectList& model) const;
  void drop_superseded();
  void refit_all();
  void look_for_random_layers();

  const MeasuredJob& job_;
  CalibrationLimits limits_;
  LayerChoice held_;
  LayerChoice seen_;
  EffectList model_;
  std::size_t declared_effects_;
  Errors first_errors_;
  Errors errors_;
  std::vector<AcceptedEffect> accepted_;
  std::optional<Remaining> remaining_;
  // Named kinds that the last regression cannot tell from its best, and that were not fitted.
  std::vector<std::string> untried_equals_;
};

}  // namespace binderjet
