// SPDX-License-Identifier: GPL-3.0-or-later
// A calibration as one HTML page that a person understands in a minute.
#pragma once

#include <string>
#include <vector>

#include "slicer/calibrate/job/calibration.h"
#include "slicer/calibrate/job/measured_job.h"

namespace binderjet {

// The page: the verdict in a sentence, the error before and after against the floor, the
// effects and how sure they are, one layer as predicted by both models against the print, the
// residual by what it could depend on, what remains, and where all of it comes from.
std::string calibration_report(const Calibration& calibration, const MeasuredJob& job,
                               const std::string& title);

// The same for the parts that other reports share. Both are markup.
std::string effects_table(const std::vector<FoundEffect>& effects);
std::string models_table(const std::vector<EffectSpec>& before,
                         const std::vector<EffectSpec>& after);

// "y, periodic (period_mm 11.8)"; "everywhere" for none.
std::string text_of(const Covariate& covariate);

}  // namespace binderjet
