// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/color/color.h"

#include <utility>

namespace binderjet {

std::shared_ptr<const ColorField> paint_field(Paint paint, const ColorSettings& settings,
                                              std::vector<std::string>& warnings) {
  if (!paint.samples.empty()) {
    return sample_field(std::move(paint.samples), std::move(paint.sample_colors),
                        settings.neighbors);
  }
  const bool white = paint.corners.empty();
  if (white && paint.has_loose_uvs()) {
    warnings.push_back(
        "has texture coordinates but names no image; for its colors name it with --texture");
  }
  if (paint.triangles.empty() || (white && paint.textures.empty())) return nullptr;
  std::vector<std::optional<Texture>> textures = load_textures(paint.textures, warnings);
  for (TextureSource& source : paint.textures) source.bytes = {};
  return surface_field(std::move(paint), std::move(textures));
}

}  // namespace binderjet
