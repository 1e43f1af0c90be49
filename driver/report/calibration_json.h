// SPDX-License-Identifier: GPL-3.0-or-later
// calibration.json: what calibrate found (slicer/MODEL.md, How calibrate chooses), for scripts.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "slicer/calibrate/job/calibration.h"

namespace binderjet {

// `profile` and `report` are names beside the file; empty where there is none.
nlohmann::ordered_json calibration_json(const Calibration& calibration, const std::string& profile,
                                        const std::string& report);

}  // namespace binderjet
