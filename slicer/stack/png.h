// SPDX-License-Identifier: GPL-3.0-or-later
// Layers as PNG files: 1-bit masks and RGB with the true resolution in the pHYs chunk.
//
// A mask is a signature and four chunks around one deflate stream. ISA-L deflates it five times
// faster than zlib at the same size, and masks are the bulk of an export; libpng cannot be given
// another deflate, so the few chunks are written here.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace binderjet {

// The file's bytes. `bits` is packed as pack() does, row 0 first; 1 is white.
std::vector<std::byte> encode_png_mask(std::span<const std::byte> bits, int width, int height,
                                       std::array<double, 2> pitch_mm);

// The same for 24-bit rows of red, green, blue.
std::vector<std::byte> encode_png_rgb(std::span<const std::byte> rgb, int width, int height,
                                      std::array<double, 2> pitch_mm);

}  // namespace binderjet
