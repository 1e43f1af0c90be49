// SPDX-License-Identifier: GPL-3.0-or-later
#include "driver/report/located_faults.h"

#include <fmt/format.h>

#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <tuple>

namespace binderjet {
namespace {

std::string depth_text(double depth_mm) {
  if (depth_mm >= Depths::kMaxMm) return fmt::format("more than {:g} mm", Depths::kMaxMm);
  return fmt::format("{:.3f} mm", depth_mm);
}

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

nlohmann::ordered_json located(std::string_view kind, const ThinPlace& place,
                               const std::array<double, 3>& origin_mm, const Grid& grid) {
  nlohmann::ordered_json json = located(kind, place.region, origin_mm, grid);
  json["widest_mm"] = rounded(place.width_mm);
  return json;
}

nlohmann::ordered_json located(const WrongPlace& place, const std::array<double, 3>& origin_mm,
                               const Grid& grid) {
  nlohmann::ordered_json at = nlohmann::ordered_json::array();
  for (std::size_t axis = 0; axis < 3; ++axis) {
    at.push_back(
        rounded(origin_mm[axis] + grid.center_mm(static_cast<int>(axis), place.voxel[axis])));
  }
  return {{"kind", word(place.kind)},
          {"at_mm", at},
          {"layer", place.voxel[2] / grid.detail_vx[2]},
          {"depth_mm", rounded(place.depth_mm)}};
}

std::string wrong_text(const nlohmann::ordered_json& located) {
  static const std::map<std::string, const char*> words = {{"lost", "into what is lost"},
                                                           {"fused", "into a gap that is fused"},
                                                           {"missing", "too thin"},
                                                           {"extra", "too thick"}};
  return depth_text(located["depth_mm"].get<double>()) + " " +
         words.at(located["kind"].get<std::string>());
}

std::string place_text(const nlohmann::ordered_json& located) {
  const auto& at = located["at_mm"];
  return fmt::format("{} at {:.1f}, {:.1f}, {:.1f} mm, layer {}", wrong_text(located),
                     at[0].get<double>(), at[1].get<double>(), at[2].get<double>(),
                     located["layer"].get<int>());
}

}  // namespace binderjet
