// SPDX-License-Identifier: GPL-3.0-or-later
// Which candidate the residual points to, without fooling itself (slicer/MODEL.md, "How
// calibrate chooses").
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

// `known` are columns of what is already in the model; the residual and the candidates are made
// orthogonal to them. The best first, then the best of each other kind and dependence that takes at
// least four fifths as much; none if there are too few points or nothing takes any.
std::vector<ScoredCandidate> rank_candidates(const MeasuredJob& job, const EffectList& model,
                                             const std::vector<SurfacePoint>& points,
                                             const std::vector<std::vector<float>>& known,
                                             const std::vector<Candidate>& candidates);

}  // namespace binderjet
