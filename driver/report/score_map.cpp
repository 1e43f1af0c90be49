// SPDX-License-Identifier: GPL-3.0-or-later
#include "driver/report/score_map.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "driver/job/print_colors.h"
#include "slicer/layers/rows.h"
#include "slicer/stack/indexed_png.h"

namespace binderjet {
namespace {

using Json = nlohmann::ordered_json;

// In the order in which they paint over each other.
enum Color : std::uint8_t { kPowder, kCorrect, kMissing, kExtra, kLost, kFused };
constexpr std::array<Rgb, 6> kPalette{kPowderColor, kCorrectColor, kMissingColor,
                                      kExtraColor,  {170, 0, 0},   {0, 0, 150}};

StackInfo map_info(const MaskSource& job, const Grid& grid) {
  StackInfo info = job.stack_info(StackKind::kColor);
  for (std::size_t axis = 0; axis < 2; ++axis) {
    info.size[axis] *= grid.detail_vx[axis];
    info.pitch_mm[axis] /= grid.detail_vx[axis];
  }
  info.files = "map_%06d.png";
  return info;
}

}  // namespace

ScoreMap::ScoreMap(const std::string& folder, const MaskSource& job, const Grid& grid)
    : origin_mm_{job.origin_mm[0], job.origin_mm[1], 0},
      grid_(grid),
      stack_(folder, map_info(job, grid)) {}

void ScoreMap::write(int index, const LayerScore& layer) const {
  const auto [width, height, layers] = stack_.info().size;
  std::vector<std::uint8_t> pixels(
      static_cast<std::size_t>(width) * static_cast<std::size_t>(height), kPowder);
  const auto paint = [&, columns = width](rows::Row row, int y, Color color) {
    std::uint8_t* out = pixels.data() + static_cast<std::ptrdiff_t>(y) * columns;
    for (std::size_t i = 0; i < row.size(); i += 2) {
      for (int x = row[i]; x < row[i + 1]; ++x) out[x] = std::max<std::uint8_t>(out[x], color);
    }
  };
  std::vector<int> row;
  for (std::size_t s = 0; s < layer.layer.target->slices.size(); ++s) {
    for (int y = 0; y < height; ++y) {
      const rows::Row target = layer.layer.target->slices[s].row(y);
      const rows::Row printed = layer.layer.printed->row(y);
      rows::intersect(target, printed, row);
      paint(row, y, kCorrect);
      rows::subtract(target, printed, row);
      paint(row, y, kMissing);
      rows::subtract(printed, target, row);
      paint(row, y, kExtra);
      paint(layer.missing.lost[s].row(y), y, kLost);
      paint(layer.missing.fused[s].row(y), y, kFused);
    }
  }
  stack_.write_encoded(index,
                       encode_indexed_png(pixels, width, height, kPalette,
                                          {stack_.info().pitch_mm[0], stack_.info().pitch_mm[1]}));
}

void ScoreMap::add(const std::vector<Fault>& faults) {
  for (const Fault& fault : faults) {
    if (fault.kind != FaultKind::kLoose && fault.kind != FaultKind::kJoined) found_.add(fault);
  }
}

void ScoreMap::finish(const JobScore& score) {
  const std::vector<Fault> listed = found_.largest();
  const Json head = {{"format", "features"},
                     {"version", 1},
                     {"lost", score.faults[FaultKind::kLost]},
                     {"fused", score.faults[FaultKind::kFused]},
                     {"spurious", score.faults[FaultKind::kSpurious]},
                     {"listed", listed.size()}};
  // One fault a line, for people and for grep.
  std::string text = head.dump();
  text.back() = ',';
  text += "\n\"features\": [";
  for (std::size_t i = 0; i < listed.size(); ++i) {
    const auto& [kind, region] = listed[i];
    text += (i == 0 ? "\n" : ",\n") + located(word(kind), region, origin_mm_, grid_).dump();
  }
  text += "\n]}\n";
  stack_.add_file("features.json", std::as_bytes(std::span(text)));
  stack_.finish();
}

}  // namespace binderjet
