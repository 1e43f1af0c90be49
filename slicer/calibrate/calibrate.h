// SPDX-License-Identifier: GPL-3.0-or-later
// Calibration: the residual of a declared model, traced to what it lacks, effect by effect.
#pragma once

#include <functional>

#include "slicer/calibrate/job/calibration.h"
#include "slicer/calibrate/job/measured_job.h"

namespace binderjet {

struct CalibrationLimits {
  // Fixed before any print is looked at. An effect is claimed only if it is this unlikely to be
  // chance among all candidates, takes this share of the residual's power where the fit did not
  // look, and this share of the printed error on layers that the fit did not see.
  double most_p = 0.01;
  double least_share = 0.015;
  // Signs of k cells drawn at random are all kept in 2^-k of the draws, so what acts in five of the
  // cells (an edge, a few layers) never has a p below 0.03, however strong it is. Its size is asked
  // for instead: a share that chance never came near (100 prints with nothing hidden: 0.002 at
  // most).
  double large_share = 0.1;
  double most_p_of_large = 0.05;
  double least_gain = 0.04;
  int most_effects = 6;

  bool sure(double p, double share) const {
    return p <= most_p || (p <= most_p_of_large && share >= large_share);
  }
};

// kEffect if one has a name, kUnexplained if those found have none; with none found kUnexplained
// if the prints say that there is something (far_above_floor()), else kNone.
Verdict verdict_of(const std::vector<FoundEffect>& effects, bool far_above);

// Whether what is left can be no chance. Where only noise parts model and print, two prints differ
// by at least as much as either does from the model, since both have noise: half as much again is
// none. A scanner adds blur, which replicates share and no model has: three times as much there.
bool far_above_floor(const BeforeAfter& score, bool scanned);

// `checks` are prints of the same printer that the fit never sees. `step` is told what is being
// done, and may throw to end it.
Calibration calibrate(const MeasuredJob& job, const std::vector<MeasuredJob>& checks,
                      const std::vector<EffectSpec>& declared, const CalibrationLimits& limits,
                      const std::function<void(const std::string&)>& step);

}  // namespace binderjet
