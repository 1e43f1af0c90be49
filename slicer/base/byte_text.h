// SPDX-License-Identifier: GPL-3.0-or-later
// Names of files are bytes; JSON, TOML and terminals want UTF-8, and terminals none of its
// commands.
//
// A byte that is not UTF-8 is written \xNN, and so is a backslash that stands before an x, which
// makes the way back unambiguous:  gr\xf6\xdfe.obj  is a name in Latin-1.
#pragma once

#include <string>
#include <string_view>

namespace binderjet {

// The bytes as UTF-8, and back.
std::string escape_bytes(std::string_view bytes);
std::string unescape_bytes(std::string_view text);

// For a terminal: what is not UTF-8, and every character that a terminal may obey (C0, DEL, C1), is
// \xNN, and nothing else changes. In visible() tabs and ends of lines, of Windows too, stay.
std::string visible(std::string_view bytes);
std::string visible_line(std::string_view bytes);

}  // namespace binderjet
