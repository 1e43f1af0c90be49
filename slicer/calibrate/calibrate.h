// SPDX-License-Identifier: GPL-3.0-or-later
// Calibration: the residual of a declared model, traced to what it lacks, effect by effect.
#pragma once

#include <functional>

#include "slicer/calibrate/calibration.h"

namespace binderjet {

struct CalibrationLimits {
  // Fixed before any print is looked at. An effect is claimed only if it is this unlikely to be
  // chance among all candidates, takes this share of the residual's power where the fit did not
  // look, and this share of the printed error on layers that the fit did not see.
  double most_p = 0.01;
  double least_share = 0.015;
  // What is in a few places only has few cells to be sure from: a share as large as this may be
  // less sure.
  double large_share = 0.1;
  double most_p_of_large = 0.05;
  double least_gain = 0.04;
  int most_effects = 6;

  bool sure(double p, double share) const {
    return p <= most_p || (p <= most_p_of_large && share >= large_share);
  }
};

// `checks` are prints of the same printer that the fit never sees. `step` is told what is being
// done, and may throw to end it.
Calibration calibrate(const MeasuredJob& job, const std::vector<MeasuredJob>& checks,
                      const std::vector<EffectSpec>& declared, const CalibrationLimits& limits,
                      const std::function<void(const std::string&)>& step);

}  // namespace binderjet
