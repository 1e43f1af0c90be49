// SPDX-License-Identifier: GPL-3.0-or-later
// Gray PNGs, which nearly all stacks are made of, in this process: without binderjet-read's start,
// and without each layer's bytes once more through a socket.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace binderjet {

// Rows from the top, 0 to 255 whatever the depth. Nothing for all that is not a sound PNG of that
// size with 1, 2, 4 or 8 bits of gray and no transparency.
std::optional<std::vector<std::uint8_t>> read_gray_png(const std::string& path, int width,
                                                       int height);

}  // namespace binderjet
