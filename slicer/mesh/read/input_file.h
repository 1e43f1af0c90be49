// SPDX-License-Identifier: GPL-3.0-or-later
// A model file read once, front to back, as lines or as bytes, in a fixed amount of memory.
#pragma once

#include <cstdint>
#include <fstream>
#include <string>
#include <string_view>
#include <vector>

namespace binderjet {

class InputFile {
 public:
  // Throws Error if the file cannot be opened.
  explicit InputFile(const std::string& path);

  const std::string& name() const { return name_; }  // without folders, for messages
  std::int64_t size() const { return size_; }
  std::int64_t remaining() const { return size_ - position_; }

  // The next line without its end, which may be LF, CR LF or a lone CR; false at the end. The view
  // is good until the next call. Throws Error on a line of over 1 MiB: no text model has one.
  bool line(std::string_view& text);

  // The next `count` (at most kBuffer) bytes, or fewer at the end of the file.
  std::string_view bytes(std::size_t count);

  // The beginning of the file without moving; only before anything was read.
  std::string_view peek(std::size_t count);

  // "gargoyle.obj: line 12": the line that line() gave last.
  std::string here() const;

  // What is odd about the line ends so far, for a warning; empty if nothing is.
  std::string odd_line_ends() const;

  static constexpr std::size_t kBuffer = std::size_t{1} << 20;

 private:
  void fill();  // moves the rest to the front of the buffer and tops it up

  std::string name_;
  std::ifstream stream_;
  std::int64_t size_ = 0;
  std::int64_t position_ = 0;
  std::int64_t line_number_ = 0;
  std::int64_t lf_ = 0, cr_ = 0, crlf_ = 0;  // lines that ended so
  std::vector<char> buffer_;
  std::size_t begin_ = 0, end_ = 0;
};

// The words of a line, one after another; empty at the end of the line.
class Words {
 public:
  explicit Words(std::string_view text) : text_(text) {}
  std::string_view next();
  std::string_view rest() const { return text_; }

 private:
  std::string_view text_;
};

// A whole word as a number. "nan" and "inf" are numbers here; false if the word is none.
bool parse_number(std::string_view word, double& value);
bool parse_number(std::string_view word, std::int64_t& value);

}  // namespace binderjet
