// SPDX-License-Identifier: GPL-3.0-or-later
// What gauges say (slicer/MODEL.md, How calibrate chooses), as one HTML page and as
// calibration.json.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "slicer/calibrate/gauges/gauge_lengths.h"
#include "slicer/calibrate/gauges/gauge_slots.h"
#include "slicer/calibrate/gauges/gauge_table.h"

namespace binderjet {

// For calibration.json, for the terminal, and for report.html.
struct GaugeSummary {
  nlohmann::ordered_json json;
  std::string text;
  std::string page;
};

GaugeSummary summarize(const SlotFindings& found, const GaugeTable& table,
                       const std::vector<EffectSpec>& declared);
GaugeSummary summarize(const LengthFindings& found, const GaugeTable& table);

// The page from its body, closed with where the table's readings come from.
std::string gauge_page(std::string body, const GaugeTable& table);

}  // namespace binderjet
