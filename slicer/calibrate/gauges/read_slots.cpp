// SPDX-License-Identifier: GPL-3.0-or-later
// Gauge tables of slots and walls, in both their forms, as readings in millimeters.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>
#include <map>

#include "slicer/base/error.h"
#include "slicer/calibrate/gauges/gauge_slots.h"

namespace binderjet {
namespace {

constexpr std::array<const char*, 3> kAxes = {"x", "y", "z"};
constexpr std::array<const char*, 2> kKinds = {"slot", "wall"};

[[noreturn]] void refuse(const GaugeTable& table, int line, const std::string& what) {
  throw Error(ErrorKind::kBadInput, fmt::format("{}:{}", table.path, line), what);
}

template <std::size_t N>
int choice(const GaugeTable& table, const GaugeTable::Row& row, const std::string& column,
           const std::array<const char*, N>& words) {
  const std::string& word = table.text(row, column);
  const auto found = std::find(words.begin(), words.end(), word);
  if (found == words.end()) {
    refuse(table, row.line,
           fmt::format("\"{}\" in column {} is none of {}", word, column, fmt::join(words, ", ")));
  }
  return static_cast<int>(found - words.begin());
}

double above_zero(const GaugeTable& table, const GaugeTable::Row& row, const std::string& column) {
  const double value = table.number(row, column);
  if (value <= 0) refuse(table, row.line, fmt::format("{} must be above 0", column));
  return value;
}

std::string visible_name(GaugeKind kind, int axis) {
  return fmt::format("first visible {} in {}", kKinds[static_cast<std::size_t>(kind)],
                     kAxes[static_cast<std::size_t>(axis)]);
}

// The narrowest that was seen and the widest that was not; the limit lies between.
GaugeReading limit(GaugeKind kind, int axis, double hidden_mm, double seen_mm) {
  return {visible_name(kind, axis), kind, axis, 0, (hidden_mm + seen_mm) / 2,
          (seen_mm - hidden_mm) / 2};
}

std::vector<GaugeReading> read_first_visible(const GaugeTable& table) {
  constexpr double kStepMm = 0.1;  // between the slots of the paper's block (section 4.1)
  std::vector<GaugeReading> readings;
  for (const GaugeTable::Row& row : table.rows) {
    const double low = above_zero(table, row, "first_visible_slot_mm_low");
    const double high = above_zero(table, row, "first_visible_slot_mm_high");
    if (high < low) refuse(table, row.line, "the first visible slot ends before it begins");
    readings.push_back(limit(GaugeKind::kSlot, choice(table, row, "axis", kAxes),
                             std::max(0.0, low - kStepMm), high));
  }
  return readings;
}

std::vector<GaugeReading> read_rows(const GaugeTable& table) {
  struct Seen {
    double hidden = 0;
    double seen = std::numeric_limits<double>::infinity();
    int line = 0;
  };
  std::map<std::pair<GaugeKind, int>, Seen> limits;
  std::vector<GaugeReading> readings;
  for (const GaugeTable::Row& row : table.rows) {
    const auto kind = static_cast<GaugeKind>(choice(table, row, "gauge", kKinds));
    const int axis = choice(table, row, "axis", kAxes);
    const double nominal = above_zero(table, row, "nominal_mm");
    if (table.has("measured_mm") && !table.text(row, "measured_mm").empty()) {
      const double measured = table.number(row, "measured_mm");
      if (measured < 0) refuse(table, row.line, "measured_mm is below 0");
      readings.push_back({fmt::format("{} of {:g} mm in {}", kKinds[static_cast<std::size_t>(kind)],
                                      nominal, kAxes[static_cast<std::size_t>(axis)]),
                          kind, axis, nominal, measured, above_zero(table, row, "uncertainty_mm")});
    } else {
      const std::string& visible = table.text(row, "visible");
      if (visible != "0" && visible != "1") {
        refuse(table, row.line, "needs measured_mm, or visible as 0 or 1");
      }
      Seen& seen = limits[{kind, axis}];
      seen.line = row.line;
      if (visible == "1") seen.seen = std::min(seen.seen, nominal);
      if (visible == "0") seen.hidden = std::max(seen.hidden, nominal);
    }
  }
  for (const auto& [gauge, seen] : limits) {
    if (seen.seen == std::numeric_limits<double>::infinity()) continue;  // bounded on one side only
    if (seen.hidden >= seen.seen) {
      refuse(table, seen.line,
             fmt::format("{}: {} mm is seen and {} mm is not",
                         visible_name(gauge.first, gauge.second), seen.seen, seen.hidden));
    }
    readings.push_back(limit(gauge.first, gauge.second, seen.hidden, seen.seen));
  }
  if (readings.empty()) refuse(table, table.rows.front().line, "no gauge of the table shows");
  return readings;
}

}  // namespace

bool has_slots(const GaugeTable& table) {
  return table.has("axis") && (table.has("first_visible_slot_mm_low") ||
                               (table.has("gauge") && table.has("nominal_mm")));
}

std::vector<GaugeReading> read_slots(const GaugeTable& table) {
  return table.has("gauge") ? read_rows(table) : read_first_visible(table);
}

}  // namespace binderjet
