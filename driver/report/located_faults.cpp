// SPDX-License-Identifier: GPL-3.0-or-later
#include "driver/report/located_faults.h"

#include <algorithm>
#include <cmath>
#include <string_view>
#include <tuple>
#include <utility>

namespace binderjet {
namespace {

bool larger(const Found& a, const Found& b) {
  const auto key = [](const Found& f) {
    return std::tuple(-f.region.voxels, f.region.low[2], f.region.low[1], f.region.low[0],
                      std::string_view(f.kind));
  };
  return key(a) < key(b);
}

// To a tenth of a micrometre; more digits would be noise.
double rounded(double mm) { return std::round(mm * 1e4) / 1e4; }

}  // namespace

void FoundRegions::add(Found found) {
  found_.push_back(std::move(found));
  if (found_.size() <= 2 * kMostListed) return;
  std::nth_element(found_.begin(), found_.begin() + kMostListed, found_.end(), larger);
  found_.resize(kMostListed);
}

std::vector<Found> FoundRegions::largest(std::size_t most) const {
  std::vector<Found> sorted = found_;
  std::sort(sorted.begin(), sorted.end(), larger);
  if (sorted.size() > most) sorted.resize(most);
  return sorted;
}

nlohmann::ordered_json to_json(const Found& found, const std::array<double, 3>& origin_mm,
                               const Grid& grid) {
  using Json = nlohmann::ordered_json;
  const Region& region = found.region;
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
  return {
      {"kind", found.kind},      {"at_mm", at},
      {"size_mm", size},         {"layers", {region.low[2] / rz, (region.high[2] + rz - 1) / rz}},
      {"voxels", region.voxels}, {"volume_mm3", static_cast<double>(region.voxels) * voxel_mm3}};
}

}  // namespace binderjet
