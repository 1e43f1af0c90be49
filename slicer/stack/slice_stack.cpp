// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/stack/slice_stack.h"

#include <fmt/printf.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <utility>

#include "slicer/base/error.h"
#include "slicer/base/whole_file.h"
#include "slicer/stack/png.h"

namespace binderjet {
namespace {

namespace fs = std::filesystem;

// A folder that a stack may take: none yet, an empty one, or an earlier stack.
void check_replaceable(const fs::path& folder) {
  std::error_code error;
  if (!fs::exists(fs::symlink_status(folder, error))) return;
  if (fs::is_directory(folder, error) &&
      (fs::is_empty(folder, error) || fs::exists(folder / "stack.json", error))) {
    return;
  }
  throw Error(ErrorKind::kUsage, folder.string(),
              "is there and is not a slice stack; name another folder");
}

nlohmann::ordered_json to_json(const StackInfo& info) {
  return {{"format", "slice-stack"},   {"version", 1},
          {"kind", word(info.kind)},   {"size", info.size},
          {"pitch_mm", info.pitch_mm}, {"origin_mm", info.origin_mm},
          {"files", info.files},       {"first", info.first}};
}

}  // namespace

std::string word(StackKind kind) {
  switch (kind) {
    case StackKind::kMask:
      return "mask";
    case StackKind::kTarget:
      return "target";
    case StackKind::kPrinted:
      return "printed";
    case StackKind::kMeasured:
      return "measured";
    case StackKind::kColor:
      break;
  }
  return "color";
}

StackWriter::StackWriter(const std::string& folder, StackInfo info)
    : folder_(folder), info_(std::move(info)) {
  while (folder_.size() > 1 && folder_.back() == '/') folder_.pop_back();
  check_replaceable(folder_);
  std::error_code error;
  const fs::path parent = fs::path(folder_).parent_path();
  if (!parent.empty()) make_folders(parent.string());
  std::string name = folder_ + ".part-XXXXXX";
  if (mkdtemp(name.data()) == nullptr) fail_to_write(folder_);
  part_ = name;
  fs::permissions(part_, fs::perms(0755), error);
}

StackWriter::~StackWriter() {
  std::error_code error;
  if (!part_.empty()) fs::remove_all(part_, error);
}

void StackWriter::write(int index, const RunLayer& layer) const {
  write_packed(index, pack(layer));
}

void StackWriter::write_packed(int index, std::span<const std::byte> bits) const {
  write_file(image_name(index), encode_png_mask(bits, info_.size[0], info_.size[1],
                                                {info_.pitch_mm[0], info_.pitch_mm[1]}));
}

void StackWriter::write_file(const std::string& name, std::span<const std::byte> bytes) const {
  binderjet::write_file(part_ + "/" + name, bytes);
}

std::string StackWriter::image_name(int index) const {
  return fmt::sprintf(info_.files, info_.first + index);
}

void StackWriter::write_rgb(int index, std::span<const std::byte> rgb) const {
  write_file(image_name(index), encode_png_rgb(rgb, info_.size[0], info_.size[1],
                                               {info_.pitch_mm[0], info_.pitch_mm[1]}));
}

void StackWriter::complete() {
  const std::string text = to_json(info_).dump(1) + "\n";
  write_file("stack.json", std::as_bytes(std::span(text)));
  complete_ = true;
}

void StackWriter::finish() {
  if (!complete_) complete();
  // A folder cannot be replaced in one step, so the earlier stack steps aside first.
  std::error_code error;
  const std::string earlier = part_ + ".earlier";
  const bool replaces = fs::exists(folder_, error);
  if (replaces) fs::rename(folder_, earlier, error);
  if (!error) fs::rename(part_, folder_, error);
  if (error) throw Error(ErrorKind::kBadInput, folder_, "cannot rename: " + error.message());
  part_.clear();
  if (replaces) fs::remove_all(earlier, error);
}

}  // namespace binderjet
