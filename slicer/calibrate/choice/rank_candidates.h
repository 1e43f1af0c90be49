// SPDX-License-Identifier: GPL-3.0-or-later
// Which candidate the residual points to (slicer/MODEL.md, How calibrate chooses): every candidate
// is fitted in folds, ranked by what it takes where the fit did not look, and judged against
// chance.
#pragma once

#include <vector>

#include "slicer/calibrate/residual/surface.h"
#include "slicer/model/effects/candidates.h"

namespace binderjet {

// A candidate that explains much of the residual.
struct ScoredCandidate {
  std::size_t place = 0;  // among the candidates
  std::vector<double> coefficients;
  double share = 0;          // of the residual's power that it takes where the fit did not look
  double p = 1;              // over all candidates
  bool folds_agree = false;  // along every axis it does not depend on (most_agree())
  // Whether the regression cannot tell it from the best: within one paired standard error.
  bool equal = false;
};

// `known`: columns of what the model has already; what they explain of the residual and of the
// candidates is taken out first. Returns the best first: those equal to the best (simplest first),
// then others with at least 4/5 of its share, one for each kind, axis and form. Empty with fewer
// than 500 points, or if no candidate gains anything.
std::vector<ScoredCandidate> rank_candidates(const MeasuredJob& job, const EffectList& model,
                                             const std::vector<SurfacePoint>& points,
                                             const std::vector<std::vector<float>>& known,
                                             const std::vector<Candidate>& candidates);

}  // namespace binderjet
