// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/base/byte_text.h"

#include <fmt/format.h>

#include <cstdint>
#include <iterator>

namespace binderjet {
namespace {

unsigned byte_at(std::string_view text, std::size_t i) {
  return i < text.size() ? static_cast<unsigned char>(text[i]) : 0;
}

// The bytes of the character at `i`, or 0 where there is none (RFC 3629: no overlong forms, no
// surrogates, nothing above U+10FFFF).
std::size_t character_size(std::string_view text, std::size_t i) {
  const unsigned lead = byte_at(text, i);
  if (lead < 0x80) return 1;
  const std::size_t size = lead >= 0xf0 ? 4 : lead >= 0xe0 ? 3 : 2;
  if (lead < 0xc2 || lead > 0xf4) return 0;
  for (std::size_t k = 1; k < size; ++k) {
    if ((byte_at(text, i + k) & 0xc0) != 0x80) return 0;
  }
  const unsigned next = byte_at(text, i + 1);
  const bool bad = (lead == 0xe0 && next < 0xa0) || (lead == 0xed && next > 0x9f) ||
                   (lead == 0xf0 && next < 0x90) || (lead == 0xf4 && next > 0x8f);
  return bad ? 0 : size;
}

// `is_kept` judges a character by its bytes; what is none is never kept.
template <class IsKept>
std::string escape_unless(std::string_view text, IsKept is_kept) {
  std::string out;
  out.reserve(text.size());
  for (std::size_t i = 0; i < text.size();) {
    const std::size_t size = character_size(text, i);
    const std::string_view character = text.substr(i, size == 0 ? 1 : size);
    if (size > 0 && is_kept(character, i)) {
      out += character;
    } else {
      for (const char byte : character) {
        fmt::format_to(std::back_inserter(out), "\\x{:02x}", static_cast<unsigned char>(byte));
      }
    }
    i += character.size();
  }
  return out;
}

bool is_obeyed(std::string_view character) {
  const unsigned first = byte_at(character, 0);
  if (character.size() == 1) return first < 0x20 || first == 0x7f;
  return character.size() == 2 && first == 0xc2 && byte_at(character, 1) < 0xa0;
}

int hex_digit(unsigned c) {
  if (c >= '0' && c <= '9') return static_cast<int>(c - '0');
  if (c >= 'a' && c <= 'f') return static_cast<int>(c - 'a' + 10);
  return -1;
}

}  // namespace

std::string escape_bytes(std::string_view bytes) {
  return escape_unless(bytes, [&](std::string_view character, std::size_t i) {
    return character != "\\" || byte_at(bytes, i + 1) != 'x';
  });
}

std::string unescape_bytes(std::string_view text) {
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const int high = hex_digit(byte_at(text, i + 2));
    const int low = hex_digit(byte_at(text, i + 3));
    if (text[i] == '\\' && byte_at(text, i + 1) == 'x' && high >= 0 && low >= 0) {
      out += static_cast<char>(16 * high + low);
      i += 3;
    } else {
      out += text[i];
    }
  }
  return out;
}

std::string visible(std::string_view bytes) {
  return escape_unless(bytes, [&](std::string_view character, std::size_t i) {
    return character == "\n" || character == "\t" || !is_obeyed(character) ||
           (character == "\r" && byte_at(bytes, i + 1) == '\n');
  });
}

std::string visible_line(std::string_view bytes) {
  return escape_unless(
      bytes, [](std::string_view character, std::size_t) { return !is_obeyed(character); });
}

}  // namespace binderjet
