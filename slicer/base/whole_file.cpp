// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/base/whole_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <mutex>
#include <random>
#include <set>

#include "slicer/base/error.h"

namespace binderjet {

namespace fs = std::filesystem;

namespace {

// Never destroyed: a thread may ask for it while the program ends.
struct Unfinished {
  std::mutex mutex;
  std::set<std::string> paths;
};
Unfinished& unfinished() {
  static Unfinished& all = *new Unfinished;
  return all;
}

}  // namespace

void note_unfinished(const std::string& path) {
  const std::lock_guard lock(unfinished().mutex);
  unfinished().paths.insert(path);
}

void forget_unfinished(const std::string& path) {
  const std::lock_guard lock(unfinished().mutex);
  unfinished().paths.erase(path);
}

void remove_unfinished() {
  unfinished().mutex.lock();
  for (const std::string& path : unfinished().paths) {
    // Other threads may still be writing into a folder.
    constexpr int kTries = 5;
    std::error_code error;
    for (int i = 0; i < kTries && fs::exists(fs::symlink_status(path, error)); ++i) {
      fs::remove_all(path, error);
    }
  }
}

WholeFile::WholeFile(const std::string& path) : path_(path) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (fs::exists(status) && !fs::is_regular_file(status)) {
    throw Error(ErrorKind::kUsage, path, "not a plain file; choose another name");
  }
  std::random_device chance;
  do {
    part_ = fmt::format("{}.part-{:08x}", path, chance());
    const int fd = open(part_.c_str(), O_CREAT | O_EXCL | O_WRONLY | O_CLOEXEC, 0666);
    if (fd >= 0) {
      close(fd);
      note_unfinished(part_);
      return;
    }
  } while (errno == EEXIST);
  fail_to_write(path);
}

WholeFile::~WholeFile() {
  if (part_.empty()) return;
  std::remove(part_.c_str());
  forget_unfinished(part_);
}

void WholeFile::keep() {
  sync_file(part_);
  forget_unfinished(part_);
  if (std::rename(part_.c_str(), path_.c_str()) != 0) fail_to_write(path_);
  part_.clear();
  sync_folder_of(path_);
}

OutputFolder::OutputFolder(const std::string& path) : path_(path) {
  std::error_code error;
  is_new_ = !fs::exists(path, error);
  make_folders(path);
}

OutputFolder::~OutputFolder() {
  if (is_new_) ::rmdir(path_.c_str());  // not where something is in it
}

void fail_to_write(const std::string& path) {
  const bool no_room = errno == ENOSPC || errno == EDQUOT || errno == EFBIG;
  throw Error(no_room ? ErrorKind::kNoRoom : ErrorKind::kBadInput, path,
              std::string("cannot write: ") + std::strerror(errno));
}

void sync_file(const std::string& path) {
  const int fd = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  const bool good = fd >= 0 && ::fsync(fd) == 0;
  const int why = errno;
  if (fd >= 0) ::close(fd);
  if (good || why == EINVAL) return;
  errno = why;
  fail_to_write(path);
}

void sync_folder_of(const std::string& path) {
  const fs::path folder = fs::path(path).parent_path();
  const int fd = ::open(folder.empty() ? "." : folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (fd < 0) return;
  ::fsync(fd);
  ::close(fd);
}

void make_folders(const std::string& path) {
  std::error_code error;
  fs::create_directories(path, error);
  if (!error) return;
  errno = error.value();
  fail_to_write(path);
}

void write_file(const std::string& path, std::span<const std::byte> bytes) {
  std::FILE* file = std::fopen(path.c_str(), "wb");
  bool good = file != nullptr;
  if (good) {
    good = bytes.empty() || std::fwrite(bytes.data(), 1, bytes.size(), file) == bytes.size();
    const int write_errno = errno;
    if (std::fclose(file) != 0) {
      good = false;
    } else if (!good) {
      errno = write_errno;
    }
  }
  if (!good) fail_to_write(path);
}

void write_whole_file(const std::string& path, std::span<const std::byte> bytes) {
  WholeFile file(path);
  write_file(file.part(), bytes);
  file.keep();
}

}  // namespace binderjet
