// SPDX-License-Identifier: GPL-3.0-or-later
// Files and folders that say what went wrong: a descriptor that closes itself, and system calls as
// Results.
#pragma once

#include <fcntl.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "transport/base/result.h"

namespace binderjet {

class File {
 public:
  File() = default;
  explicit File(int fd) : fd_(fd) {}
  File(File&& other) noexcept;
  File& operator=(File&& other) noexcept;
  ~File();

  int fd() const { return fd_; }
  explicit operator bool() const { return fd_ >= 0; }

 private:
  int fd_ = -1;
};

// errno as a Failure: a full disk or quota is kNoRoom, all else is `otherwise`. `doing` is a verb:
// "cannot write".
Failure system_failure(int error, const std::string& path, const std::string& doing,
                       FailureKind otherwise = FailureKind::kDevice);

// `flags` as open(2); descriptors never survive an exec.
Result<File> open_file(const std::string& path, int flags,
                       FailureKind otherwise = FailureKind::kDevice);
// Bytes of a regular file; anything else is kBadInput.
Result<std::uint64_t> file_bytes(const File& file, const std::string& path);
Result<void> write_all(const File& file, std::span<const std::byte> bytes, const std::string& path);
// Fills `bytes` from `offset`; an earlier end of the file is kBadInput. Several threads may read at
// once.
Result<void> read_at(const File& file, std::uint64_t offset, std::span<std::byte> bytes,
                     const std::string& path);
// On return the bytes survive a loss of power.
Result<void> sync_file(const File& file, const std::string& path);
// On return the folder's names survive a loss of power.
Result<void> sync_folder(const std::string& folder);
Result<void> rename_path(const std::string& from, const std::string& to);
// Creates the folder itself, never its parents; one that is there already is fine.
Result<void> make_folder(const std::string& folder);
bool path_exists(const std::string& path);
// The folder part of a path; "." if there is none.
std::string folder_of(const std::string& path);

}  // namespace binderjet
