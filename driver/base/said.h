// SPDX-License-Identifier: GPL-3.0-or-later
// The program's two ways out: stdout for results, stderr for all else. No byte of a file, a name or
// a device that a terminal would obey passes here.
#pragma once

#include <string>

namespace binderjet {

// stdin, stdout and stderr, where they are closed, become places that nothing can be written to, so
// that no file of ours gets their numbers and our words. To be called before anything is opened.
void hold_standard_files();

// One line on stderr, whatever lines `text` has. That nobody can read it is no reason to stop.
void say_line(const std::string& text) noexcept;

// A line on stderr that comes from beside the work: it takes the place of what the work painted at
// a terminal's foot, and is not said where somebody would have to be waited for who no longer
// reads.
void say_aside(const std::string& text) noexcept;

// On stdout, at once. Error{kNoRoom} or Error{kBadInput} if not all of it arrived.
void say_result(const std::string& text);

}  // namespace binderjet
