// SPDX-License-Identifier: GPL-3.0-or-later
// The residual as figures: mean distance between predicted and measured surface along each axis.
#pragma once

#include <vector>

#include "slicer/calibrate/job/calibration.h"
#include "slicer/calibrate/job/measured_job.h"

namespace binderjet {

// By x, y, layer, facing, distance from the edge of the box and local density.
std::vector<ResidualProfile> residual_profiles(const MeasuredJob& job,
                                               const std::vector<EffectSpec>& before,
                                               const std::vector<EffectSpec>& after);

}  // namespace binderjet
