// SPDX-License-Identifier: GPL-3.0-or-later
// The system calls behind files and folders, each answered by a Result.
#include "transport/base/file.h"

#include <fmt/core.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <system_error>
#include <utility>

namespace binderjet {

File::File(File&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}

File& File::operator=(File&& other) noexcept {
  std::swap(fd_, other.fd_);
  return *this;
}

File::~File() {
  if (fd_ >= 0) close(fd_);
}

Failure system_failure(int error, const std::string& path, const std::string& doing,
                       FailureKind otherwise) {
  if (error == ENOSPC || error == EDQUOT || error == EFBIG) {
    return {FailureKind::kNoRoom, path, doing + ": the disk is full; make room and try again"};
  }
  return {otherwise, path, fmt::format("{}: {}", doing, std::generic_category().message(error))};
}

Result<File> open_file(const std::string& path, int flags, FailureKind otherwise) {
  // O_NONBLOCK means nothing to a plain file; a FIFO opens at once, to be refused by file_bytes().
  const int fd = ::open(path.c_str(), flags | O_CLOEXEC | O_NONBLOCK, 0666);
  if (fd < 0) {
    const char* doing = (flags & O_CREAT) != 0 ? "cannot create it" : "cannot open it";
    return tl::unexpected(system_failure(errno, path, doing, otherwise));
  }
  return File(fd);
}

Result<std::uint64_t> file_bytes(const File& file, const std::string& path) {
  struct stat info = {};
  if (fstat(file.fd(), &info) != 0) {
    return tl::unexpected(system_failure(errno, path, "cannot look at it", FailureKind::kBadInput));
  }
  if (!S_ISREG(info.st_mode)) {
    return tl::unexpected(Failure{FailureKind::kBadInput, path, "not a plain file"});
  }
  return static_cast<std::uint64_t>(info.st_size);
}

Result<void> write_all(const File& file, std::span<const std::byte> bytes,
                       const std::string& path) {
  while (!bytes.empty()) {
    const ssize_t done = ::write(file.fd(), bytes.data(), bytes.size());
    if (done < 0 && errno == EINTR) continue;
    if (done < 0) return tl::unexpected(system_failure(errno, path, "cannot write"));
    bytes = bytes.subspan(static_cast<std::size_t>(done));
  }
  return {};
}

Result<void> read_at(const File& file, std::uint64_t offset, std::span<std::byte> bytes,
                     const std::string& path) {
  while (!bytes.empty()) {
    const ssize_t done = ::pread(file.fd(), bytes.data(), bytes.size(), static_cast<off_t>(offset));
    if (done < 0 && errno == EINTR) continue;
    if (done < 0) {
      return tl::unexpected(system_failure(errno, path, "cannot read", FailureKind::kBadInput));
    }
    if (done == 0) {
      return tl::unexpected(Failure{FailureKind::kBadInput, path, "ends too early"});
    }
    bytes = bytes.subspan(static_cast<std::size_t>(done));
    offset += static_cast<std::uint64_t>(done);
  }
  return {};
}

Result<void> sync_file(const File& file, const std::string& path) {
  // fdatasync also writes the length where it changed, which is all that reading back needs.
  if (fdatasync(file.fd()) != 0) {
    return tl::unexpected(system_failure(errno, path, "cannot write to the disk"));
  }
  return {};
}

Result<void> sync_folder(const std::string& folder) {
  const Result<File> file = open_file(folder, O_RDONLY | O_DIRECTORY);
  if (!file) return tl::unexpected(file.error());
  // EINVAL: a file system that has no such thing.
  if (fsync(file->fd()) != 0 && errno != EINVAL) {
    return tl::unexpected(system_failure(errno, folder, "cannot write to the disk"));
  }
  return {};
}

Result<void> rename_path(const std::string& from, const std::string& to) {
  if (std::rename(from.c_str(), to.c_str()) != 0) {
    return tl::unexpected(system_failure(errno, to, "cannot give it its name"));
  }
  return {};
}

Result<void> make_folder(const std::string& folder) {
  if (mkdir(folder.c_str(), 0777) != 0 && errno != EEXIST) {
    return tl::unexpected(system_failure(errno, folder, "cannot create the folder"));
  }
  return {};
}

bool path_exists(const std::string& path) {
  struct stat info = {};
  return lstat(path.c_str(), &info) == 0;
}

std::string folder_of(const std::string& path) {
  const std::size_t slash = path.rfind('/');
  if (slash == std::string::npos) return ".";
  return slash == 0 ? "/" : path.substr(0, slash);
}

}  // namespace binderjet
