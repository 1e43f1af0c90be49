// SPDX-License-Identifier: GPL-3.0-or-later
// Slice stacks in: stack.json checked, images of any format.
#include <fmt/printf.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "slicer/base/error.h"
#include "slicer/base/plain_file.h"
#include "slicer/base/strict_json.h"
#include "slicer/images/read_image.h"
#include "slicer/stack/gray_png.h"
#include "slicer/stack/slice_stack.h"

namespace binderjet {
namespace {

// Of a file in the folder itself, which the system reads as it is written.
bool is_plain_name(const std::string& name) {
  return !name.empty() && name != "." && name != ".." &&
         name.find_first_of(std::string("/\0", 2)) == std::string::npos;
}

// A pattern with exactly one %d or %0Nd and no other %, so that printf can be trusted with it, and
// no way out of the folder.
bool good_pattern(const std::string& files) {
  const std::size_t percent = files.find('%');
  if (percent == std::string::npos || !is_plain_name(files)) return false;
  std::size_t i = percent + 1;
  while (i < files.size() && files[i] >= '0' && files[i] <= '9' && i < percent + 4) ++i;
  return i < files.size() && files[i] == 'd' && files.find('%', i) == std::string::npos;
}

// With the largest size still an int.
constexpr int kMaxImages = 1 << 30;

StackKind kind_of(const std::string& name, const std::string& where) {
  for (const StackKind kind : {StackKind::kMask, StackKind::kTarget, StackKind::kPrinted,
                               StackKind::kMeasured, StackKind::kColor}) {
    if (word(kind) == name) return kind;
  }
  throw Error(ErrorKind::kBadInput, where,
              "kind \"" + name + "\" is none of mask, target, printed, measured, color");
}

}  // namespace

StackInfo read_stack_info(const std::string& folder) {
  const std::string path = folder + "/stack.json";
  demand_plain_file(path);
  std::ifstream file(path);
  if (!file) throw Error(ErrorKind::kBadInput, path, "is not there; is this a slice stack?");
  try {
    const nlohmann::json json = nlohmann::json::parse(file);
    if (json.at("format") != "slice-stack" || json.at("version") != 1) {
      throw Error(ErrorKind::kBadInput, path, "is not a slice-stack of version 1");
    }
    StackInfo info;
    info.kind = kind_of(json.at("kind").get<std::string>(), path);
    get_int(json.at("size"), info.size, path);
    json.at("pitch_mm").get_to(info.pitch_mm);
    json.at("origin_mm").get_to(info.origin_mm);
    json.at("files").get_to(info.files);
    get_int(json.at("first"), info.first, path);
    if (json.contains("also")) json.at("also").get_to(info.also);
    for (const std::string& name : info.also) {
      if (!is_plain_name(name)) {
        throw Error(ErrorKind::kBadInput, path, "\"also\" names files of the folder, no others");
      }
    }
    info.threshold_stated = json.contains("threshold");
    if (info.threshold_stated) get_int(json.at("threshold"), info.threshold, path);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      constexpr int kMost = 1 << 20;
      if (info.size[axis] < 1 || info.size[axis] > kMost) {
        throw Error(ErrorKind::kBadInput, path, "has a size outside 1 to 2^20");
      }
      if (!(info.pitch_mm[axis] >= 1e-4 && info.pitch_mm[axis] < 1000)) {
        throw Error(ErrorKind::kBadInput, path, "has a pitch outside 0.0001 to 1000 mm");
      }
      if (!(std::abs(info.origin_mm[axis]) <= 1e6)) {
        throw Error(ErrorKind::kBadInput, path, "has an origin more than a kilometer away");
      }
    }
    // Gray values of a whole image are held at once.
    constexpr std::int64_t kMostSamples = 1 << 28;
    if (std::int64_t{info.size[0]} * info.size[1] > kMostSamples) {
      throw Error(ErrorKind::kBadInput, path, "has images of more than 2^28 samples");
    }
    if (info.first < 0 || info.first > kMaxImages) {
      throw Error(ErrorKind::kBadInput, path, "numbers its images from outside 0 to 2^30");
    }
    if (!good_pattern(info.files)) {
      throw Error(ErrorKind::kBadInput, path,
                  "\"files\" needs one %d, such as \"mask_%06d.png\", and no folder");
    }
    return info;
  } catch (const nlohmann::json::exception& error) {
    throw Error(ErrorKind::kBadInput, path, error.what());
  }
}

StackReader::StackReader(const std::string& folder)
    : folder_(folder), info_(read_stack_info(folder)) {
  for (int index = 0; index < info_.size[2]; ++index) {
    std::error_code error;
    demand_plain_file(image_path(index));
    if (!std::filesystem::exists(image_path(index), error)) {
      throw Error(ErrorKind::kBadInput, image_path(index),
                  "is missing from the stack; copy the whole folder");
    }
  }
}

std::string StackReader::image_path(int index) const {
  return folder_ + "/" + fmt::sprintf(info_.files, info_.first + index);
}

std::vector<std::uint8_t> StackReader::read_gray(int index) const {
  const std::string path = image_path(index);
  if (auto gray = read_gray_png(path, info_.size[0], info_.size[1])) return std::move(*gray);
  Image image = read_gray_image({path, {}, path});
  if (image.width != info_.size[0] || image.height != info_.size[1]) {
    throw Error(ErrorKind::kBadInput, path,
                fmt::format("is {} x {} pixels, stack.json says {} x {}", image.width, image.height,
                            info_.size[0], info_.size[1]));
  }
  return std::move(image.samples);
}

RunLayer StackReader::read(int index) const {
  const std::vector<std::uint8_t> gray = read_gray(index);
  const auto [width, height, count] = info_.size;
  RunLayer layer(width);
  layer.reserve(height, 0);
  const std::uint8_t* sample = gray.data();
  for (int y = 0; y < height; ++y) {
    layer.append_row_where([&](int) { return *sample++ >= info_.threshold; });
  }
  return layer;
}

}  // namespace binderjet
