// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/calibrate/gauges/gauge_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <set>

#include "slicer/base/error.h"
#include "slicer/base/plain_file.h"

namespace binderjet {
namespace {

// Nobody reads so many by hand, and what is done with them grows by their square.
constexpr std::size_t kMostRows = 5000;

[[noreturn]] void refuse(const std::string& path, int line, const std::string& what) {
  throw Error(ErrorKind::kBadInput, fmt::format("{}:{}", path, line), what);
}

std::string trimmed(const std::string& text) {
  const auto first = text.find_first_not_of(" \t");
  if (first == std::string::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

// The cells of one line (RFC 4180, but no line ends within quotes).
std::vector<std::string> split(const std::string& line, const std::string& path, int number) {
  std::vector<std::string> cells(1);
  bool quoted = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const char c = line[i];
    if (quoted && c == '"' && i + 1 < line.size() && line[i + 1] == '"') {
      cells.back() += line[++i];
    } else if (c == '"' && (quoted || trimmed(cells.back()).empty())) {
      quoted = !quoted;
    } else if (c == ',' && !quoted) {
      cells.emplace_back();
    } else {
      cells.back() += c;
    }
  }
  if (quoted) refuse(path, number, "a quote is not closed on its line");
  for (std::string& cell : cells) cell = trimmed(cell);
  return cells;
}

}  // namespace

std::optional<std::size_t> GaugeTable::find(const std::string& column) const {
  const auto found = std::find(header.begin(), header.end(), column);
  if (found == header.end()) return std::nullopt;
  return static_cast<std::size_t>(found - header.begin());
}

double GaugeTable::number(const Row& row, std::size_t column) const {
  const std::string& cell = row.cells[column];
  double value = 0;
  const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
  if (error != std::errc() || end != cell.data() + cell.size() || !std::isfinite(value)) {
    refuse(path, row.line, fmt::format("\"{}\" in column {} is no number", cell, header[column]));
  }
  constexpr double kMost = 1e6;
  if (std::abs(value) > kMost) {
    refuse(path, row.line,
           fmt::format("\"{}\" in column {} is beyond {:g}", cell, header[column], kMost));
  }
  return value;
}

double GaugeTable::number(const Row& row, const std::string& column) const {
  const auto place = find(column);
  if (!place) refuse(path, 1, "has no column " + column);
  return number(row, *place);
}

const std::string& GaugeTable::text(const Row& row, const std::string& column) const {
  const auto place = find(column);
  if (!place) refuse(path, 1, "has no column " + column);
  return row.cells[*place];
}

GaugeTable read_gauge_table(const std::string& path) {
  demand_plain_file(path);
  std::ifstream file(path);
  if (!file) throw Error(ErrorKind::kBadInput, path, "cannot be read");
  GaugeTable table;
  table.path = path;
  std::string line;
  for (int number = 1; std::getline(file, line); ++number) {
    if (!line.empty() && line.back() == '\r') line.pop_back();
    if (trimmed(line).empty()) continue;
    if (line.front() == '#') {
      table.remarks.push_back(trimmed(line.substr(1)));
      continue;
    }
    std::vector<std::string> cells = split(line, path, number);
    if (table.header.empty()) {
      if (std::set<std::string>(cells.begin(), cells.end()).size() != cells.size()) {
        refuse(path, number, "names a column twice");
      }
      table.header = std::move(cells);
    } else if (cells.size() != table.header.size()) {
      refuse(path, number,
             fmt::format("has {} cells, the header has {}", cells.size(), table.header.size()));
    } else if (table.rows.size() == kMostRows) {
      refuse(path, number,
             fmt::format("is one row more than the {} that are traced at once; readings of one "
                         "printer fit in fewer",
                         kMostRows));
    } else {
      table.rows.push_back({number, std::move(cells)});
    }
  }
  if (table.rows.empty()) throw Error(ErrorKind::kBadInput, path, "holds no rows of readings");
  return table;
}

}  // namespace binderjet
