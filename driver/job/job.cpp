// SPDX-License-Identifier: GPL-3.0-or-later
#include "driver/job/job.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "driver/base/files.h"
#include "slicer/base/byte_text.h"
#include "slicer/base/error.h"
#include "slicer/base/strict_json.h"

namespace binderjet {
namespace {

using Json = nlohmann::ordered_json;

Json to_json(const Source& source) {
  Json json = {{"file", escape_bytes(source.file)},         {"hash", source.hash},
               {"unit_mm", source.placement.unit_mm},       {"scale", source.placement.scale},
               {"rotate_deg", source.placement.rotate_deg}, {"corner_px", source.corner_px}};
  if (source.placement.wall_mm > 0) json["wall_mm"] = source.placement.wall_mm;
  return json;
}

Source source_of(const Json& json, const std::string& where) {
  Source source;
  source.file = unescape_bytes(json.at("file").get<std::string>());
  json.at("hash").get_to(source.hash);
  json.at("unit_mm").get_to(source.placement.unit_mm);
  json.at("scale").get_to(source.placement.scale);
  json.at("rotate_deg").get_to(source.placement.rotate_deg);
  get_int(json.at("corner_px"), source.corner_px, where);
  source.placement.wall_mm = json.value("wall_mm", 0.0);
  return source;
}

Enhancement enhancement_in(const Json& json, const std::string& where) {
  const auto text = json.at("enhance").get<std::string>();
  const std::optional<Enhancement> known = enhancement_of(text);
  if (!known) {
    throw Error(ErrorKind::kBadInput, where,
                "has masks of a kind that this program does not know: \"" + text + "\"");
  }
  return *known;
}

// What a job says of itself is a stranger's word until its numbers make sense.
void check_ranges(const JobHeader& header, const std::string& where) {
  const auto demand = [&](const char* name, auto value, double least, double most) {
    if (value >= least && value <= most) return;
    throw Error(
        ErrorKind::kBadInput, where,
        fmt::format("has a header whose {} is {}, not {:g} to {:g}", name, value, least, most));
  };
  constexpr double kMostPixels = 1 << 24;
  for (const int size : header.box.size_px) demand("size_px", size, 1, kMostPixels);
  for (const int margin : header.box.margin_px) demand("margin_px", margin, 0, 1 << 16);
  for (const int place : header.box.bed_px) demand("bed_px", place, -kMostPixels, kMostPixels);
  for (const double pitch : header.grid.pitch_mm) demand("pitch_mm", pitch, 1e-3, 100);
  for (const int detail : header.grid.detail_vx) demand("detail_vx", detail, 1, 16);
  demand("passes", header.passes, 0, 16);
  demand("number of sources", static_cast<int>(header.sources.size()), 1, 1e6);
  for (const Source& source : header.sources) {
    const Placement& placement = source.placement;
    demand("unit_mm", placement.unit_mm, 1e-9, 1e9);
    demand("scale", placement.scale, kLeastScale, kMostScale);
    demand("wall_mm", placement.wall_mm, 0, kMostWallMm);
    for (const double degrees : placement.rotate_deg)
      demand("rotate_deg", degrees, -kMostDegrees, kMostDegrees);
    for (const int corner : source.corner_px)
      demand("corner_px", corner, -kMostPixels, kMostPixels);
  }
}

}  // namespace

std::array<int, 2> lower_corner(const std::vector<Source>& sources) {
  std::array<int, 2> corner = sources.front().corner_px;
  for (const Source& source : sources) {
    for (std::size_t axis = 0; axis < 2; ++axis) {
      corner[axis] = std::min(corner[axis], source.corner_px[axis]);
    }
  }
  return corner;
}

std::array<double, 3> JobHeader::origin_mm() const {
  std::array<double, 3> origin{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    origin[axis] = box.bed_px[axis] * grid.pitch_mm[axis];
  }
  return origin;
}

std::string to_text(const JobHeader& header) {
  Json sources = Json::array();
  for (const Source& source : header.sources) sources.push_back(to_json(source));
  Json json = {{"format", "binderjet-job"},
               {"version", 1},
               {"program", BINDERJET_VERSION},
               {"size_px", header.box.size_px},
               {"pitch_mm", header.grid.pitch_mm},
               {"detail_vx", header.grid.detail_vx},
               {"origin_mm", header.origin_mm()},
               {"margin_px", header.box.margin_px},
               {"bed_px", header.box.bed_px},
               {"enhance", word(header.enhance)},
               {"passes", header.passes},
               {"sources", sources},
               {"profile",
                {{"name", header.profile.name},
                 {"hash", text_hash(header.profile.text)},
                 {"text", header.profile.text}}}};
  // Only where it is, so that plain jobs stay byte for byte what they were.
  if (header.enhance == Enhancement::kInverse) json["robust"] = header.robust;
  if (header.color) json["color"] = {{"enhanced", header.color_enhanced}};
  return json.dump();
}

JobHeader parse_job_header(const std::string& text, const std::string& where) {
  try {
    const Json json = Json::parse(text);
    if (json.at("format") != "binderjet-job" || json.at("version") != 1) {
      throw Error(ErrorKind::kBadInput, where,
                  "is a job of another version; slice it with this program");
    }
    JobHeader header;
    header.profile =
        parse_profile(json.at("profile").at("text").get<std::string>(), where + ": profile");
    get_int(json.at("size_px"), header.box.size_px, where);
    get_int(json.at("margin_px"), header.box.margin_px, where);
    get_int(json.at("bed_px"), header.box.bed_px, where);
    json.at("pitch_mm").get_to(header.grid.pitch_mm);
    get_int(json.at("detail_vx"), header.grid.detail_vx, where);
    header.enhance = enhancement_in(json, where);
    get_int(json.at("passes"), header.passes, where);
    header.robust = json.value("robust", true);
    header.color = json.contains("color");
    if (header.color) json.at("color").at("enhanced").get_to(header.color_enhanced);
    for (const Json& source : json.at("sources")) {
      header.sources.push_back(source_of(source, where));
    }
    check_ranges(header, where);
    return header;
  } catch (const Json::exception& error) {
    throw Error(ErrorKind::kBadInput, where,
                std::string("has a header that this program does not read: ") + error.what());
  }
}

}  // namespace binderjet
