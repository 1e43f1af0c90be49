// SPDX-License-Identifier: GPL-3.0-or-later
// A table of gauge readings: a CSV file with a header line, read strictly.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace binderjet {

// Lines that start with # are remarks, blank lines are none; cells may be quoted ("a ""b"", c").
struct GaugeTable {
  std::string path;
  std::vector<std::string> remarks;  // without the #
  std::vector<std::string> header;
  struct Row {
    int line = 0;                    // of the file, from 1
    std::vector<std::string> cells;  // as many as the header has
  };
  std::vector<Row> rows;

  std::optional<std::size_t> find(const std::string& column) const;
  bool has(const std::string& column) const { return find(column).has_value(); }
  // The cell as a number; Error{kBadInput} with file, line and column if it is none or not finite.
  double number(const Row& row, std::size_t column) const;
  // The same, with a name that must be there.
  double number(const Row& row, const std::string& column) const;
  const std::string& text(const Row& row, const std::string& column) const;
};

// Error{kBadInput} with file:line for a row with more or fewer cells than the header, a column that
// is there twice, an open quote, a table without rows.
GaugeTable read_gauge_table(const std::string& path);

}  // namespace binderjet
