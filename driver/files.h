// SPDX-License-Identifier: GPL-3.0-or-later
// Whole files in, and their fingerprint.
#pragma once

#include <cstdint>
#include <string>

namespace binderjet {

// The file's bytes; Error{kBadInput} with the path if it cannot be read.
std::string read_text(const std::string& path);

// XXH3-64 of the file's bytes, as 16 hexadecimal digits; read in pieces.
std::string file_hash(const std::string& path);
std::string text_hash(const std::string& text);

}  // namespace binderjet
