// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/color/texture.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "slicer/base/error.h"
#include "slicer/images/read_image.h"

namespace binderjet {
namespace {

// The place in an image of `size` texels along one axis.
int texel(float place, float low, float high, Tiling tiling, int size) {
  const float tile = std::floor((low + high) / 2);
  if (tiling == Tiling::kClamp) {
    // as it is
  } else if (low >= tile && high <= tile + 1) {
    place -= tile;
    if (tiling == Tiling::kMirror && std::fmod(std::abs(tile), 2.0F) == 1.0F) place = 1 - place;
  } else if (tiling == Tiling::kMirror) {
    const float twice = place - 2 * std::floor(place / 2);
    place = twice > 1 ? 2 - twice : twice;
  } else {
    place -= std::floor(place);
  }
  const float scaled = std::floor(place * static_cast<float>(size));
  return static_cast<int>(std::clamp(scaled, 0.0F, static_cast<float>(size - 1)));
}

}  // namespace

Rgb Texture::at(const Uv& uv, const std::array<Uv, 3>& corners) const {
  const auto [low_u, high_u] = std::minmax({corners[0][0], corners[1][0], corners[2][0]});
  const auto [low_v, high_v] = std::minmax({corners[0][1], corners[1][1], corners[2][1]});
  const int x = texel(uv[0], low_u, high_u, tiling[0], width);
  const int y = height - 1 - texel(uv[1], low_v, high_v, tiling[1], height);
  const std::uint8_t* t =
      rgb.data() + 3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                        static_cast<std::size_t>(x));
  return {t[0], t[1], t[2]};
}

std::vector<std::optional<Texture>> load_textures(const std::vector<TextureSource>& sources,
                                                  std::vector<std::string>& warnings,
                                                  std::int64_t texels) {
  const auto image_of = [](const TextureSource& source) {
    return ImageSource{source.path, source.bytes, source.name};
  };
  std::int64_t total = 0;
  std::vector<bool> good;
  for (const TextureSource& source : sources) {
    try {
      const Image size = read_image_size(image_of(source));
      total += std::int64_t{size.width} * size.height;
      good.push_back(true);
    } catch (const Error& error) {
      if (error.kind() != ErrorKind::kBadInput) throw;
      good.push_back(false);
    }
  }
  const int factor = std::max(1, static_cast<int>(std::ceil(std::sqrt(
                                     static_cast<double>(total) / static_cast<double>(texels)))));
  std::vector<std::optional<Texture>> textures;
  for (std::size_t i = 0; i < sources.size(); ++i) {
    std::optional<Texture> texture;
    try {
      if (good[i]) {
        Image image = read_color_image(image_of(sources[i]), factor);
        texture = Texture{image.width, image.height, std::move(image.samples), sources[i].tiling};
      }
    } catch (const Error& error) {
      if (error.kind() != ErrorKind::kBadInput) throw;
    }
    if (!texture) {
      // The words of the decoder name no remedy.
      warnings.push_back(fmt::format("its image \"{}\" cannot be decoded; painted in neutral gray",
                                     sources[i].name));
    }
    textures.push_back(std::move(texture));
  }
  return textures;
}

}  // namespace binderjet
