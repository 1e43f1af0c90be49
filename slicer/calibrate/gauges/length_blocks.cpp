// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/calibrate/gauges/length_blocks.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "slicer/base/error.h"

namespace binderjet {

std::vector<std::size_t> axes_in(const GaugeTable& table) {
  std::vector<std::size_t> axes;
  for (std::size_t a = 0; a < 3; ++a) {
    const std::string axis = kAxisNames[a];
    if (table.has("nominal_" + axis) && table.has("meas_" + axis)) axes.push_back(a);
  }
  return axes;
}

std::vector<LengthBlock> blocks_of(const GaugeTable& table) {
  const auto word = [&](const GaugeTable::Row& row, const std::string& column) {
    return table.has(column) ? table.text(row, column) : std::string();
  };
  std::vector<LengthBlock> blocks;
  for (const GaugeTable::Row& row : table.rows) {
    LengthBlock block;
    block.line = row.line;
    block.batch = word(row, "batch");
    // Without a part number each row is a part of its own.
    block.part = table.has("part") ? word(row, "part") : fmt::format("line {}", row.line);
    if (table.has("part") && block.part.find_first_not_of("0123456789") == std::string::npos) {
      block.number = table.number(row, "part");
    }
    block.reading = word(row, "rep");
    for (std::size_t a = 0; a < 2; ++a) {
      const std::string column = fmt::format("pos_{}_mm", kAxisNames[a]);
      if (table.has(column)) block.position_mm[a] = table.number(row, column);
    }
    for (const std::size_t a : axes_in(table)) {
      const std::string axis = kAxisNames[a];
      block.nominal[a] = table.number(row, "nominal_" + axis);
      if (block.nominal[a] <= 0) {
        throw Error(ErrorKind::kBadInput, fmt::format("{}:{}", table.path, row.line),
                    "a nominal length must be above 0");
      }
      block.error[a] = table.number(row, "meas_" + axis) - block.nominal[a];
      block.worst = std::max(block.worst, std::abs(block.error[a]));
    }
    blocks.push_back(std::move(block));
  }
  return blocks;
}

std::vector<std::string> batches_of(const std::vector<LengthBlock>& blocks) {
  std::vector<std::string> batches;
  for (const LengthBlock& block : blocks) {
    if (std::find(batches.begin(), batches.end(), block.batch) == batches.end()) {
      batches.push_back(block.batch);
    }
  }
  return batches;
}

void drop_broken(std::vector<LengthBlock>& blocks, double drop_mm,
                 std::vector<std::string>& dropped) {
  const auto broken = [&](const LengthBlock& block) { return block.worst > drop_mm; };
  for (const std::string& batch : batches_of(blocks)) {
    const auto in_batch = [&](const LengthBlock& block) { return block.batch == batch; };
    const auto rows = std::count_if(blocks.begin(), blocks.end(), in_batch);
    const auto off = std::count_if(blocks.begin(), blocks.end(),
                                   [&](const LengthBlock& b) { return in_batch(b) && broken(b); });
    if (2 * off <= rows) continue;
    std::erase_if(blocks, in_batch);
    dropped.push_back(fmt::format("batch {}: broken, {} of its {} rows are off by more than {} mm",
                                  batch, off, rows, drop_mm));
  }
  std::vector<int> lines;
  for (const LengthBlock& block : blocks) {
    if (broken(block)) lines.push_back(block.line);
  }
  std::erase_if(blocks, broken);
  if (lines.empty()) return;
  dropped.push_back(fmt::format("{} single row{} off by more than {} mm: line{} {}", lines.size(),
                                lines.size() == 1 ? "" : "s", drop_mm, lines.size() == 1 ? "" : "s",
                                fmt::join(lines, ", ")));
}

void keep_one_layout(std::vector<LengthBlock>& blocks, std::vector<std::string>& dropped) {
  std::map<std::string, std::set<std::string>> parts;
  for (const LengthBlock& block : blocks) parts[block.batch].insert(block.part);
  std::map<std::set<std::string>, int> layouts;
  for (const auto& [batch, layout] : parts) ++layouts[layout];
  if (layouts.size() < 2) return;
  const auto common =
      std::max_element(layouts.begin(), layouts.end(),
                       [](const auto& a, const auto& b) { return a.second < b.second; });
  if (common->second < 2) return;
  for (const std::string& batch : batches_of(blocks)) {
    if (parts[batch] == common->first) continue;
    dropped.push_back(fmt::format(
        "batch {}: its part numbers are not those of the other batches, so they are other places",
        batch));
    std::erase_if(blocks, [&](const LengthBlock& block) { return block.batch == batch; });
  }
}

}  // namespace binderjet
