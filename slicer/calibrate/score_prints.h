// SPDX-License-Identifier: GPL-3.0-or-later
// How far a prediction is from a print, before and after a calibration.
#pragma once

#include <string>

#include "slicer/calibrate/job/calibration.h"
#include "slicer/calibrate/residual/surface.h"

namespace binderjet {

// Both models on the chosen layers of a job, and the replicates against each other.
BeforeAfter score_models(const MeasuredJob& job, const std::string& name,
                         const std::vector<EffectSpec>& before,
                         const std::vector<EffectSpec>& after, const LayerChoice& layers);

}  // namespace binderjet
