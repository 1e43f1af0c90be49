// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/color/texture.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>

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

// An image open for reading, from a file or from bytes.
struct Open {
  std::unique_ptr<OIIO::Filesystem::IOMemReader> memory;
  std::unique_ptr<OIIO::ImageInput> input;
};

const char* format_of(const std::vector<std::byte>& bytes) {
  const auto starts = [&](std::initializer_list<unsigned> magic) {
    std::size_t i = 0;
    return bytes.size() >= magic.size() && std::all_of(magic.begin(), magic.end(), [&](unsigned m) {
             return std::to_integer<unsigned>(bytes[i++]) == m;
           });
  };
  if (starts({0xff, 0xd8})) return "image.jpg";
  if (starts({'R', 'I', 'F', 'F'})) return "image.webp";
  if (starts({'B', 'M'})) return "image.bmp";
  return "image.png";
}

Open open_image(const TextureSource& source) {
  Open open;
  OIIO::ImageSpec config;
  config.attribute("oiio:UnassociatedAlpha", 1);  // a transparent texel keeps its color
  if (source.path.empty()) {
    // Not ImageInput::open, which looks for a file of that name even so.
    const char* name = format_of(source.bytes);
    open.memory = std::make_unique<OIIO::Filesystem::IOMemReader>(
        const_cast<std::byte*>(source.bytes.data()), source.bytes.size());
    open.input = OIIO::ImageInput::create(name, false, nullptr, open.memory.get());
    OIIO::ImageSpec spec;
    const bool good = open.input != nullptr && open.input->set_ioproxy(open.memory.get()) &&
                      open.input->open(name, spec, config);
    if (!good) open.input.reset();
  } else {
    open.input = OIIO::ImageInput::open(source.path, &config);
  }
  return open;
}

// Averages factor x factor texels into one, a few rows of the file at a time.
std::optional<Texture> decode(OIIO::ImageInput& input, int factor) {
  const OIIO::ImageSpec spec = input.spec();
  const int channels = spec.nchannels >= 3 ? 3 : 1;
  Texture texture;
  texture.width = std::max(1, spec.width / factor);
  texture.height = std::max(1, spec.height / factor);
  const int rows_at_once = spec.tile_width > 0 ? spec.height : factor;
  const auto stride = static_cast<std::size_t>(spec.width) * static_cast<std::size_t>(channels);
  std::vector<std::uint8_t> rows(stride * static_cast<std::size_t>(rows_at_once));
  texture.rgb.resize(3 * static_cast<std::size_t>(texture.width) *
                     static_cast<std::size_t>(texture.height));
  std::uint8_t* out = texture.rgb.data();
  for (int y = 0; y < texture.height; ++y) {
    const int first = y * factor;
    const int last = std::min(spec.height, first + factor);
    if (spec.tile_width > 0) {
      if (y == 0 && !input.read_image(0, 0, 0, channels, OIIO::TypeDesc::UINT8, rows.data())) {
        return std::nullopt;
      }
    } else if (!input.read_scanlines(0, 0, spec.y + first, spec.y + last, 0, 0, channels,
                                     OIIO::TypeDesc::UINT8, rows.data())) {
      return std::nullopt;
    }
    const std::size_t base = spec.tile_width > 0 ? static_cast<std::size_t>(first) : 0;
    for (int x = 0; x < texture.width; ++x) {
      const int x_last = std::min(spec.width, (x + 1) * factor);
      for (int c = 0; c < 3; ++c) {
        unsigned sum = 0;
        for (int j = 0; j < last - first; ++j) {
          for (int i = x * factor; i < x_last; ++i) {
            sum += rows[(base + static_cast<std::size_t>(j)) * stride +
                        static_cast<std::size_t>(i * channels + (channels == 3 ? c : 0))];
          }
        }
        const auto count = static_cast<unsigned>((last - first) * (x_last - x * factor));
        *out++ = static_cast<std::uint8_t>((sum + count / 2) / count);
      }
    }
  }
  return texture;
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
  constexpr std::int64_t kMost = std::int64_t{1} << 31;
  std::vector<Open> open;
  std::int64_t total = 0;
  for (const TextureSource& source : sources) {
    open.push_back(open_image(source));
    if (open.back().input == nullptr) continue;
    const OIIO::ImageSpec& spec = open.back().input->spec();
    const std::int64_t area = std::int64_t{spec.width} * spec.height;
    if (spec.width < 1 || spec.height < 1 || area > kMost) {
      open.back().input.reset();
    } else {
      total += area;
    }
  }
  const int factor = std::max(1, static_cast<int>(std::ceil(std::sqrt(
                                     static_cast<double>(total) / static_cast<double>(texels)))));
  std::vector<std::optional<Texture>> textures;
  for (std::size_t i = 0; i < sources.size(); ++i) {
    std::optional<Texture> texture;
    if (open[i].input != nullptr) texture = decode(*open[i].input, factor);
    open[i].input.reset();
    if (texture) {
      texture->tiling = sources[i].tiling;
    } else {
      OIIO::geterror();  // forgets it: the words of the library name no remedy
      warnings.push_back(fmt::format("its image \"{}\" cannot be decoded; painted in neutral gray",
                                     sources[i].name));
    }
    textures.push_back(std::move(texture));
  }
  return textures;
}

}  // namespace binderjet
