// SPDX-License-Identifier: GPL-3.0-or-later
#include "driver/score_map.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <tuple>

#include "driver/print_colors.h"
#include "slicer/rows.h"
#include "slicer/stack/indexed_png.h"

namespace binderjet {
namespace {

using Json = nlohmann::ordered_json;

// In the order in which they paint over each other.
enum Color : std::uint8_t { kPowder, kCorrect, kMissing, kExtra, kLost, kFused };
constexpr std::array<Rgb, 6> kPalette{kPowderColor, kCorrectColor, kMissingColor,
                                      kExtraColor,  {170, 0, 0},   {0, 0, 150}};

constexpr std::size_t kMostListed = 10000;

StackInfo map_info(const MaskSource& job, const Grid& grid) {
  StackInfo info = job.stack_info(StackKind::kColor);
  for (std::size_t axis = 0; axis < 2; ++axis) {
    info.size[axis] *= grid.detail_vx[axis];
    info.pitch_mm[axis] /= grid.detail_vx[axis];
  }
  info.files = "map_%06d.png";
  return info;
}

bool larger(const Feature& a, const Feature& b) {
  const auto key = [](const Feature& f) {
    return std::tuple(-f.region.voxels, f.region.low[2], f.region.low[1], f.region.low[0], f.kind);
  };
  return key(a) < key(b);
}

// To a tenth of a micrometre; more digits would be noise.
double rounded(double mm) { return std::round(mm * 1e4) / 1e4; }

Json to_json(const Feature& feature, const std::array<double, 3>& origin_mm, const Grid& grid) {
  const Region& region = feature.region;
  Json at = Json::array();
  Json size = Json::array();
  double voxel_mm3 = 1;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double voxel_mm = grid.voxel_mm(static_cast<int>(axis));
    at.push_back(
        rounded(origin_mm[axis] + (region.low[axis] + region.high[axis]) / 2.0 * voxel_mm));
    size.push_back(rounded((region.high[axis] - region.low[axis]) * voxel_mm));
    voxel_mm3 *= voxel_mm;
  }
  const int rz = grid.detail_vx[2];
  return {{"kind", word(feature.kind)},
          {"at_mm", at},
          {"size_mm", size},
          {"layers", {region.low[2] / rz, (region.high[2] + rz - 1) / rz}},
          {"voxels", region.voxels},
          {"volume_mm3", static_cast<double>(region.voxels) * voxel_mm3}};
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
      paint(layer.features.lost[s].row(y), y, kLost);
      paint(layer.features.fused[s].row(y), y, kFused);
    }
  }
  stack_.write_file(stack_.image_name(index),
                    encode_indexed_png(pixels, width, height, kPalette,
                                       {stack_.info().pitch_mm[0], stack_.info().pitch_mm[1]}));
}

void ScoreMap::add(const std::vector<Feature>& features) {
  features_.insert(features_.end(), features.begin(), features.end());
  if (features_.size() <= 2 * kMostListed) return;
  std::nth_element(features_.begin(), features_.begin() + kMostListed, features_.end(), larger);
  features_.resize(kMostListed);
}

void ScoreMap::finish(const Score& score) {
  std::sort(features_.begin(), features_.end(), larger);
  if (features_.size() > kMostListed) features_.resize(kMostListed);
  const Json head = {{"format", "features"},         {"version", 1},
                     {"lost", score.lost()},         {"fused", score.fused()},
                     {"spurious", score.spurious()}, {"listed", features_.size()}};
  // One feature a line, for people and for grep.
  std::string text = head.dump();
  text.back() = ',';
  text += "\n\"features\": [";
  for (std::size_t i = 0; i < features_.size(); ++i) {
    text += (i == 0 ? "\n" : ",\n") + to_json(features_[i], origin_mm_, grid_).dump();
  }
  text += "\n]}\n";
  stack_.write_file("features.json", std::as_bytes(std::span(text)));
  stack_.finish();
}

}  // namespace binderjet
