// SPDX-License-Identifier: GPL-3.0-or-later
// Whole files in and out, and their fingerprint.
#pragma once

#include <cstdint>
#include <string>

namespace binderjet {

// The file's bytes; Error{kBadInput} with the path if it cannot be read.
std::string read_text(const std::string& path);

// Writes the file whole or not at all. Error{kNoRoom} or {kBadInput} with the path if it cannot.
void write_text(const std::string& path, const std::string& text);

// XXH3-64 of the file's bytes, as 16 hexadecimal digits; read in pieces.
std::string file_hash(const std::string& path);
std::string text_hash(const std::string& text);

}  // namespace binderjet
