// SPDX-License-Identifier: GPL-3.0-or-later
#include "driver/report/located_faults.h"

#include <cmath>
#include <nlohmann/json.hpp>
#include <tuple>

namespace binderjet {
namespace {

auto key(const Region& region) {
  return std::tuple(-region.voxels, region.low[2], region.low[1], region.low[0]);
}

// To a tenth of a micrometer; more digits would be noise.
double rounded(double mm) { return std::round(mm * 1e4) / 1e4; }

}  // namespace

bool larger(const Region& a, const Region& b) { return key(a) < key(b); }

bool larger(const Fault& a, const Fault& b) {
  return std::tuple(key(a.region), word(a.kind)) < std::tuple(key(b.region), word(b.kind));
}

bool larger(const ThinPlace& a, const ThinPlace& b) {
  return std::tuple(a.width_mm, key(a.region)) < std::tuple(b.width_mm, key(b.region));
}

nlohmann::ordered_json located(std::string_view kind, const Region& region,
                               const std::array<double, 3>& origin_mm, const Grid& grid) {
  using Json = nlohmann::ordered_json;
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
  return {{"kind", kind},
          {"at_mm", at},
          {"size_mm", size},
          {"layers", {region.low[2] / rz, (region.high[2] + rz - 1) / rz}},
          {"voxels", region.voxels},
          {"volume_mm3", static_cast<double>(region.voxels) * voxel_mm3}};
}

}  // namespace binderjet
