// SPDX-License-Identifier: GPL-3.0-or-later
// Pictures of a few colors as PNG files: four bits a pixel and a palette.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace binderjet {

using Rgb = std::array<std::uint8_t, 3>;

// The file's bytes. `pixels` are width * height places in the palette, row 0 first; the palette
// has at most 16 colors.
std::vector<std::byte> encode_indexed_png(std::span<const std::uint8_t> pixels, int width,
                                          int height, std::span<const Rgb> palette,
                                          std::array<double, 2> pitch_mm);

}  // namespace binderjet
