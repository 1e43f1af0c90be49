// SPDX-License-Identifier: GPL-3.0-or-later
// The rows of a table of lengths, and which of them can be used.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "slicer/calibrate/gauges/gauge_table.h"

namespace binderjet {

inline constexpr std::array<const char*, 3> kAxisNames = {"x", "y", "z"};

// One row of the file: one reading of each axis.
struct LengthBlock {
  int line = 0;
  std::string batch;
  std::string part;
  std::string reading;
  std::optional<double> number;  // of the part, if it is a number
  std::array<std::optional<double>, 2> position_mm;
  std::array<double, 3> nominal{};
  std::array<double, 3> error{};  // measured - nominal; 0 on an axis that is not in the file
  double worst = 0;
};

// The axes that the table has both lengths of.
std::vector<std::size_t> axes_in(const GaugeTable& table);
// Error{kBadInput} with file:line for a number that is none or a nominal length not above 0.
std::vector<LengthBlock> blocks_of(const GaugeTable& table);
// In the order in which they come.
std::vector<std::string> batches_of(const std::vector<LengthBlock>& blocks);

// Takes out batches with more than half of their rows off by more than `drop_mm`, then rows that
// are; `dropped` gets a line for each.
void drop_broken(std::vector<LengthBlock>& blocks, double drop_mm,
                 std::vector<std::string>& dropped);
// Where parts lay is only told by their number, which means the same place only in batches that
// were laid out alike: those of the most common layout stay.
void keep_one_layout(std::vector<LengthBlock>& blocks, std::vector<std::string>& dropped);

}  // namespace binderjet
