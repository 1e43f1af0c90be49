// SPDX-License-Identifier: GPL-3.0-or-later
// A decoded image and its texel at a place, each texel a square of one color.
//
// Texels are not blended: an edge in the image is where the mesh puts it, and a printed pixel
// averages what its voxels see anyway.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "slicer/mesh/paint.h"

namespace binderjet {

struct Texture {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> rgb;  // rows from the top
  std::array<Tiling, 2> tiling{};

  // At a point of a triangle with these corners. A triangle within one tile sees no other, so that
  // u = 1 is the last column and not the first of the next tile.
  Rgb at(const Uv& uv, const std::array<Uv, 3>& corners) const;
};

// Decodes what binderjet-read knows; alpha is left out. Above `texels` for all images together each
// is averaged down by a whole factor, which bounds memory; 2^24 are still finer than the printer's
// pixels on a part as large as the bed. An image that cannot be decoded is none, with a warning.
std::vector<std::optional<Texture>> load_textures(const std::vector<TextureSource>& sources,
                                                  std::vector<std::string>& warnings,
                                                  std::int64_t texels = std::int64_t{1} << 24);

}  // namespace binderjet
