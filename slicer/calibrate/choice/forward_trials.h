// SPDX-License-Identifier: GPL-3.0-or-later
// Effects that no regression of the residual can see, since they move no dose: layers that were
// lost, gaps that were filled, edges that wore off. They are tried in the forward model itself, and
// the printed voxels decide, cell by cell.
#pragma once

#include <vector>

#include "slicer/calibrate/residual/surface.h"
#include "slicer/model/effects/candidates.h"

namespace binderjet {

// The best trial of one kind.
struct ScoredTrial {
  Candidate candidate;  // without columns; its model is `model`
  EffectList model;
  double share = 0;          // of the wrong voxels that it takes away
  double p = 1;              // over all that was tried
  bool folds_agree = false;  // along every axis it does not depend on (most_agree())
};

// Those that make the print of the chosen layers better, the best first.
std::vector<ScoredTrial> rank_trials(const MeasuredJob& job, const EffectList& model,
                                     const LayerChoice& layers);

// The model with the numbers of this effect that are searched (NumberRule::search_step) moved to
// where the chosen layers are printed best.
EffectList with_places_fitted(const MeasuredJob& job, EffectList model, std::size_t effect,
                              const LayerChoice& layers);

}  // namespace binderjet
