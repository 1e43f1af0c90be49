// SPDX-License-Identifier: GPL-3.0-or-later
// Whole files in and out, and their fingerprint.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "driver/base/give_name.h"

struct XXH3_state_s;

namespace binderjet {

// The file's bytes; Error{kBadInput} with the path if it cannot be read.
std::string read_text(const std::string& path);

// Writes the file whole or not at all. Error{kNoRoom} or {kBadInput} with the path if it cannot.
void write_text(const std::string& path, const std::string& text);

// The same for files that belong together: none gets its name before there was room for all.
struct TextFile {
  std::string path, text;
};
void write_texts(const std::vector<TextFile>& files);
// Writes the file, and returns what gives it its name.
[[nodiscard]] GiveName write_unnamed(const TextFile& file);

// XXH3-64 of all that it is given, as 16 hexadecimal digits.
class Fingerprint {
 public:
  Fingerprint();
  void add(std::span<const std::byte> bytes);
  // The count goes first, so that no two lists in a row are taken for two others. T has no padding.
  template <class T>
  void add_list(const std::vector<T>& values) {
    static_assert(std::is_trivially_copyable_v<T>);
    const std::uint64_t count = values.size();
    add(std::as_bytes(std::span(&count, 1)));
    add(std::as_bytes(std::span(values)));
  }
  std::string text() const;

 private:
  std::shared_ptr<XXH3_state_s> state_;
};

// XXH3-64 of the file's bytes, as 16 hexadecimal digits; read in pieces.
std::string file_hash(const std::string& path);
std::string text_hash(const std::string& text);

}  // namespace binderjet
