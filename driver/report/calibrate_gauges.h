// SPDX-License-Identifier: GPL-3.0-or-later
// calibrate --gauges: readings of a caliper or an eye, traced to what the declared model lacks.
#pragma once

#include <string>

#include "driver/base/console.h"

namespace binderjet {

// Reads the table (slicer/calibrate/gauges/gauge_slots.h and gauge_lengths.h say which columns),
// writes `folder`/calibration.json and report.html, and, where slots or walls name a change of the
// model, `folder`/NAME.calibrated.toml. Error{kBadInput} for a table of neither kind.
void calibrate_gauges(const std::string& profile, const std::string& gauges,
                      const std::string& folder, const Console& console);

}  // namespace binderjet
