// SPDX-License-Identifier: GPL-3.0-or-later
// Calibration: the residual of a declared model, traced to what it lacks, effect by effect.
#pragma once

#include "slicer/calibrate/job/calibration.h"
#include "slicer/calibrate/job/measured_job.h"

namespace binderjet {

struct CalibrationLimits {
  // Fixed before any print is looked at (slicer/MODEL.md, How calibrate chooses, has the reasons).
  double max_p = 0.01;       // chance, over all candidates together
  double min_share = 0.015;  // of the residual's power, where the fit did not look
  double min_gain = 0.04;    // of the printed error, on layers that the fit did not see
  // k cells keep all their signs in 2^-k of the draws, so what acts in five cells (an edge, a few
  // layers) has p >= 0.03 however strong it is. From large_share on p up to max_p_of_large is
  // enough: 100 prints with nothing hidden reached a share of 0.002.
  double large_share = 0.1;
  double max_p_of_large = 0.05;
  int max_effects = 6;

  bool sure(double p, double share) const {
    return p <= max_p || (p <= max_p_of_large && share >= large_share);
  }
};

// kEffect if one has a name, kUnexplained if those found have none; with none found kUnexplained
// if the prints say that there is something (far_above_floor()), else kNone.
Verdict verdict_of(const std::vector<FoundEffect>& effects, bool far_above);

// Whether the print is farther from the model than chance allows:
//
//   wrong(model, print) > f * wrong(print 1, print 2)       f = 1.5; 3 for prints that were scanned
//
// With noise alone f could be 1: two noisy prints differ from each other by at least as much as
// either differs from the model. A scanner blurs both prints alike and the model not at all, so
// there f is larger. One print alone gives no floor, and then the answer is no.
bool far_above_floor(const BeforeAfter& score, bool scanned);

// `checks` are prints of the same printer that the fit never sees. The work is told to job.work.
Calibration calibrate(const MeasuredJob& job, const std::vector<MeasuredJob>& checks,
                      const std::vector<EffectSpec>& declared, const CalibrationLimits& limits);

}  // namespace binderjet
