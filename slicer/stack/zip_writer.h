// SPDX-License-Identifier: GPL-3.0-or-later
// ZIP archives written entry by entry: entries are stored as they are, for PNGs are deflated
// already.
//
// The same entries give the same bytes: no clock and no name of a user gets in.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <string_view>

namespace binderjet {

// An archive that is not finished vanishes. Every call throws Error{kNoRoom} or {kBadInput} with
// the archive's path if it cannot write.
class ZipWriter {
 public:
  explicit ZipWriter(const std::string& path);
  ~ZipWriter();
  ZipWriter(const ZipWriter&) = delete;
  ZipWriter& operator=(const ZipWriter&) = delete;

  // `name` is relative, with slashes; less than 4 GB each, any number of them.
  void add(const std::string& name, std::span<const std::byte> bytes);
  void add(const std::string& name, std::string_view text);
  // Writes what is left; then only the archive's name is missing.
  void complete();
  // Gives the archive its name, complete() before that if need be.
  void finish();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace binderjet
