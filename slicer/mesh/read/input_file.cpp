// SPDX-License-Identifier: GPL-3.0-or-later
// Buffered lines, bytes, words and numbers of a model file.
#include "slicer/mesh/read/input_file.h"

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstdlib>
#include <cstring>
#include <filesystem>

#include "slicer/base/error.h"
#include "slicer/base/plain_file.h"

namespace binderjet {

InputFile::InputFile(const std::string& path)
    : name_(std::filesystem::path(path).filename().string()) {
  std::error_code problem;
  if (std::filesystem::is_directory(path, problem)) {
    throw Error(ErrorKind::kBadInput, path, "is a folder; name a model file");
  }
  demand_plain_file(path);
  errno = 0;
  stream_.open(path, std::ios::binary);
  if (!stream_) {
    throw Error(ErrorKind::kBadInput, path, "cannot be opened: " + std::string(strerror(errno)));
  }
  const auto size = std::filesystem::file_size(path, problem);
  if (problem) {
    throw Error(ErrorKind::kBadInput, path, "is not a plain file; save the model to a file first");
  }
  size_ = static_cast<std::int64_t>(size);
  buffer_.resize(kBuffer);
}

void InputFile::fill() {
  std::copy(buffer_.data() + begin_, buffer_.data() + end_, buffer_.data());
  end_ -= begin_;
  begin_ = 0;
  stream_.read(buffer_.data() + end_, static_cast<std::streamsize>(kBuffer - end_));
  if (stream_.bad()) throw Error(ErrorKind::kBadInput, name_, "reading failed; check the disk");
  end_ += static_cast<std::size_t>(stream_.gcount());
}

bool InputFile::line(std::string_view& text) {
  const auto is_end = [](char c) { return c == '\n' || c == '\r'; };
  auto stop = std::find_if(buffer_.data() + begin_, buffer_.data() + end_, is_end);
  // One byte beyond the line's end must be there to tell CR from CR LF.
  if (stop + 1 >= buffer_.data() + end_) {
    fill();
    stop = std::find_if(buffer_.data() + begin_, buffer_.data() + end_, is_end);
  }
  if (begin_ == end_) return false;
  ++line_number_;
  const auto length = static_cast<std::size_t>(stop - (buffer_.data() + begin_));
  if (length == kBuffer) {
    throw Error(ErrorKind::kBadInput, here(), "is over 1 MiB long; this is no text model");
  }
  text = {buffer_.data() + begin_, length};
  begin_ += length;
  std::size_t ending = 0;
  if (begin_ < end_) {
    const bool cr = buffer_[begin_] == '\r';
    ending = cr && begin_ + 1 < end_ && buffer_[begin_ + 1] == '\n' ? 2 : 1;
    ++(ending == 2 ? crlf_ : cr ? cr_ : lf_);
  }
  begin_ += ending;
  position_ += static_cast<std::int64_t>(length + ending);
  return true;
}

std::string_view InputFile::bytes(std::size_t count) {
  if (end_ - begin_ < count) fill();
  count = std::min(count, end_ - begin_);
  const std::string_view result(buffer_.data() + begin_, count);
  begin_ += count;
  position_ += static_cast<std::int64_t>(count);
  return result;
}

std::string_view InputFile::peek(std::size_t count) {
  if (end_ - begin_ < count) fill();
  return {buffer_.data() + begin_, std::min(count, end_ - begin_)};
}

std::string InputFile::here() const { return name_ + ": line " + std::to_string(line_number_); }

std::string InputFile::odd_line_ends() const {
  if ((lf_ > 0) + (cr_ > 0) + (crlf_ > 0) > 1)
    return "its lines end in different ways; all are read";
  return cr_ > 0 ? "its lines end in CR alone; read as lines" : "";
}

std::string_view Words::next() {
  const auto is_space = [](char c) { return c == ' ' || c == '\t' || c == '\v' || c == '\f'; };
  const auto* first = std::find_if_not(text_.begin(), text_.end(), is_space);
  const auto* last = std::find_if(first, text_.end(), is_space);
  text_ = {last, static_cast<std::size_t>(text_.end() - last)};
  return {first, static_cast<std::size_t>(last - first)};
}

bool parse_number(std::string_view word, double& value) {
  if (word.starts_with('+')) word.remove_prefix(1);
  const char* end = word.data() + word.size();
  const auto [stop, problem] = std::from_chars(word.data(), end, value);
  if (word.empty() || stop != end) return false;
  // from_chars leaves the value alone when it over- or underflows; strtod gives infinity or zero.
  if (problem != std::errc{}) value = std::strtod(std::string(word).c_str(), nullptr);
  return true;
}

bool parse_number(std::string_view word, std::int64_t& value) {
  if (word.starts_with('+')) word.remove_prefix(1);
  const char* end = word.data() + word.size();
  const auto [stop, problem] = std::from_chars(word.data(), end, value);
  return !word.empty() && stop == end && problem == std::errc{};
}

}  // namespace binderjet
