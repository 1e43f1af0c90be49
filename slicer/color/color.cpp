// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/color/color.h"

#include <algorithm>
#include <array>
#include <utility>

namespace binderjet {

std::shared_ptr<const ColorField> paint_field(Paint paint, const ColorSettings& settings,
                                              std::vector<std::string>& warnings) {
  if (!paint.samples.empty()) {
    return sample_field(paint.samples, std::move(paint.sample_colors), settings.neighbors);
  }
  const bool white = paint.corners.empty();
  if (white && paint.has_loose_uvs()) {
    warnings.push_back(
        "has texture coordinates but names no image; for its colors name it with --texture");
  }
  if (paint.triangles.empty() || (white && paint.textures.empty())) return nullptr;
  // One color all over needs no search for the nearest triangle, which is most of coloring's cost.
  const auto& corners = paint.corners;
  const auto same = [&](const std::array<Rgb, 3>& triangle) {
    return std::all_of(triangle.begin(), triangle.end(),
                       [&](const Rgb& color) { return color == corners.front().front(); });
  };
  if (!white && paint.textures.empty() && std::all_of(corners.begin(), corners.end(), same)) {
    return plain_field(corners.front().front());
  }
  std::vector<std::optional<Texture>> textures = load_textures(paint.textures, warnings);
  for (TextureSource& source : paint.textures) source.bytes = {};
  return surface_field(std::move(paint), std::move(textures));
}

}  // namespace binderjet
