// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/stack/slice_stack.h"

#include <fcntl.h>
#include <fmt/printf.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <random>
#include <unordered_set>
#include <utility>

#include "slicer/base/error.h"
#include "slicer/base/whole_file.h"
#include "slicer/stack/png.h"

namespace binderjet {
namespace {

namespace fs = std::filesystem;

// The names of a stack's files.
std::unordered_set<std::string> names_of(const StackInfo& info) {
  std::unordered_set<std::string> names(info.also.begin(), info.also.end());
  names.insert("stack.json");
  // The maps of a score, before stack.json named what else there is.
  if (info.kind == StackKind::kColor) names.insert("features.json");
  for (int i = 0; i < info.size[2]; ++i) names.insert(fmt::sprintf(info.files, info.first + i));
  return names;
}

// The files that stand at a folder's name before a stack does, as they were seen there: only these
// are ever removed, whatever stack.json claims.
std::vector<std::string> earlier_files(const fs::path& folder) {
  const auto refuse = [&](const std::string& why) {
    throw Error(ErrorKind::kUsage, folder.string(), why + "; name another folder");
  };
  std::error_code error;
  const fs::file_status status = fs::symlink_status(folder, error);
  if (!fs::exists(status)) return {};
  if (!fs::is_directory(status)) refuse("is there and is not a slice stack");
  std::vector<fs::directory_entry> entries;
  for (fs::directory_iterator i(folder, error), end; !error && i != end; i.increment(error)) {
    entries.push_back(*i);
  }
  if (error) refuse("cannot be looked into: " + error.message());
  if (entries.empty()) return {};
  std::unordered_set<std::string> named;
  try {
    named = names_of(read_stack_info(folder.string()));
  } catch (const Error&) {
    refuse("is there and is not a slice stack");
  }
  std::vector<std::string> names;
  for (const fs::directory_entry& entry : entries) {
    const std::string name = entry.path().filename().string();
    if (!named.contains(name) || !fs::is_regular_file(entry.symlink_status(error))) {
      refuse("holds " + name + ", which is no file of the slice stack there");
    }
    names.push_back(name);
  }
  return names;
}

// Somebody may have put a file there meanwhile: then the folder stays, with that file.
void remove_stack(const fs::path& folder, const std::vector<std::string>& names) {
  std::error_code error;
  for (const std::string& name : names) fs::remove(folder / name, error);
  fs::remove(folder, error);
}

// One step: `to` is at no moment without a folder. False with errno, and all as it was.
bool change_places(const std::string& from, const std::string& to) {
  if (::renameat2(AT_FDCWD, from.c_str(), AT_FDCWD, to.c_str(), RENAME_EXCHANGE) == 0) return true;
  if (errno != EINVAL && errno != ENOSYS) return false;
  // A file system without it (NFS among them): two steps, the first taken back if the second fails.
  const std::string aside = from + ".earlier";
  if (std::rename(to.c_str(), aside.c_str()) != 0) return false;
  if (std::rename(from.c_str(), to.c_str()) != 0) {
    const int why = errno;
    std::rename(aside.c_str(), to.c_str());
    errno = why;
    return false;
  }
  std::rename(aside.c_str(), from.c_str());
  return true;
}

nlohmann::ordered_json to_json(const StackInfo& info) {
  nlohmann::ordered_json json = {{"format", "slice-stack"},   {"version", 1},
                                 {"kind", word(info.kind)},   {"size", info.size},
                                 {"pitch_mm", info.pitch_mm}, {"origin_mm", info.origin_mm},
                                 {"files", info.files},       {"first", info.first}};
  if (!info.also.empty()) json["also"] = info.also;
  return json;
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
  earlier_files(folder_);
  const fs::path parent = fs::path(folder_).parent_path();
  if (!parent.empty()) make_folders(parent.string());
  // Not mkdtemp, whose folder is for its owner alone: this one is for whom the umask lets.
  std::random_device chance;
  do {
    part_ = fmt::format("{}.part-{:08x}", folder_, chance());
    if (::mkdir(part_.c_str(), 0777) == 0) {
      note_unfinished(part_);
      return;
    }
  } while (errno == EEXIST);
  part_.clear();
  fail_to_write(folder_);
}

StackWriter::~StackWriter() {
  if (part_.empty()) return;
  std::error_code error;
  fs::remove_all(part_, error);
  forget_unfinished(part_);
}

void StackWriter::write(int index, const RunLayer& layer) const {
  write_packed(index, pack(layer));
}

void StackWriter::write_packed(int index, std::span<const std::byte> bits) const {
  write_encoded(index, encode_png_mask(bits, info_.size[0], info_.size[1],
                                       {info_.pitch_mm[0], info_.pitch_mm[1]}));
}

void StackWriter::write_file(const std::string& name, std::span<const std::byte> bytes) const {
  binderjet::write_file(part_ + "/" + name, bytes);
}

void StackWriter::write_encoded(int index, std::span<const std::byte> file) const {
  write_file(fmt::sprintf(info_.files, info_.first + index), file);
}

void StackWriter::add_file(const std::string& name, std::span<const std::byte> bytes) {
  write_file(name, bytes);
  info_.also.push_back(name);
}

void StackWriter::write_rgb(int index, std::span<const std::byte> rgb) const {
  write_encoded(index, encode_png_rgb(rgb, info_.size[0], info_.size[1],
                                      {info_.pitch_mm[0], info_.pitch_mm[1]}));
}

void StackWriter::complete() {
  const std::string text = to_json(info_).dump(1) + "\n";
  write_file("stack.json", std::as_bytes(std::span(text)));
  // All images were written before the first is waited for, so that the disk had time meanwhile.
  for (const auto& entry : fs::directory_iterator(part_)) sync_file(entry.path().string());
  sync_file(part_);
  complete_ = true;
}

void StackWriter::finish() {
  if (!complete_) complete();
  const std::vector<std::string> earlier = earlier_files(folder_);
  forget_unfinished(part_);
  std::error_code error;
  if (fs::exists(folder_, error)) {
    if (!change_places(part_, folder_)) fail_to_write(folder_);
    remove_stack(std::exchange(part_, ""), earlier);
  } else {
    if (std::rename(part_.c_str(), folder_.c_str()) != 0) fail_to_write(folder_);
    part_.clear();
  }
  sync_folder_of(folder_);
}

}  // namespace binderjet
