// SPDX-License-Identifier: GPL-3.0-or-later
// What is read must be a plain file: a FIFO waits for ever for somebody to write, a device never
// ends.
#pragma once

#include <string>

namespace binderjet {

// Error{kBadInput} if something stands at `path` that is no plain file, links followed. Nothing
// there is no error: who opens it says so.
void demand_plain_file(const std::string& path);

}  // namespace binderjet
