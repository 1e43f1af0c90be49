// SPDX-License-Identifier: GPL-3.0-or-later
#include "driver/read/decode_image.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cstring>
#include <fstream>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace binderjet {
namespace {

// An image open for reading, from a file or from bytes.
struct Open {
  std::unique_ptr<OIIO::Filesystem::IOMemReader> memory;
  std::unique_ptr<OIIO::ImageInput> input;
};

// OpenImageIO's name of the format that the bytes begin with. Its other decoders, some of which
// crash on a stranger's bytes or take gigabytes for them, are not asked. TGA begins with nothing of
// its own.
const char* format_of(std::span<const std::byte> begin, const std::string& path) {
  const auto starts = [&](std::string_view magic) {
    return begin.size() >= magic.size() &&
           std::memcmp(begin.data(), magic.data(), magic.size()) == 0;
  };
  if (starts("\x89PNG")) return "png";
  if (starts("\xff\xd8")) return "jpeg";
  if (starts("RIFF")) return "webp";
  if (starts("BM")) return "bmp";
  if (starts({"II*\0", 4}) || starts({"MM\0*", 4}) || starts({"II+\0", 4}) ||
      starts({"MM\0+", 4})) {
    return "tiff";
  }
  if (begin.size() > 1 && starts("P") && begin[1] >= std::byte{'1'} && begin[1] <= std::byte{'6'}) {
    return "pnm";
  }
  if (path.ends_with(".tga") || path.ends_with(".TGA")) return "targa";
  throw std::runtime_error("is none of PNG, TIFF, JPEG, WebP, BMP, TGA and PNM");
}

std::vector<std::byte> first_bytes(const std::string& path) {
  std::vector<std::byte> bytes(16);
  std::ifstream file(path, std::ios::binary);
  file.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  bytes.resize(static_cast<std::size_t>(std::max<std::streamsize>(file.gcount(), 0)));
  return bytes;
}

Open open_image(const ImageRequest& request, std::span<const std::byte> content) {
  Open open;
  OIIO::ImageSpec spec;
  OIIO::ImageSpec config;
  // A transparent texel keeps its color.
  if (request.wish != ImageWish::kGray) config.attribute("oiio:UnassociatedAlpha", 1);
  // Not ImageInput::open, which chooses by the file's name, and looks for one even for bytes.
  if (request.is_path != 0) {
    const std::string path(reinterpret_cast<const char*>(content.data()), content.size());
    open.input = OIIO::ImageInput::create(format_of(first_bytes(path), path));
    if (open.input != nullptr && !open.input->open(path, spec, config)) {
      throw std::runtime_error(open.input->geterror());
    }
  } else {
    const char* format = format_of(content, "");
    open.memory = std::make_unique<OIIO::Filesystem::IOMemReader>(
        const_cast<std::byte*>(content.data()), content.size());
    open.input = OIIO::ImageInput::create(format, false, nullptr, open.memory.get());
    const bool good = open.input != nullptr && open.input->set_ioproxy(open.memory.get()) &&
                      open.input->open(std::string("image.") + format, spec, config);
    if (!good) open.input.reset();
  }
  if (open.input == nullptr) throw std::runtime_error(OIIO::geterror());
  return open;
}

DecodedImage decode_gray(OIIO::ImageInput& input) {
  const OIIO::ImageSpec& spec = input.spec();
  DecodedImage image{spec.width, spec.height, {}};
  image.samples.resize(static_cast<std::size_t>(spec.width) *
                       static_cast<std::size_t>(spec.height));
  if (!input.read_image(0, 0, 0, 1, OIIO::TypeDesc::UINT8, image.samples.data())) {
    throw std::runtime_error(input.geterror());
  }
  return image;
}

// Averages factor x factor pixels into one, a few rows of the file at a time.
DecodedImage decode_color(OIIO::ImageInput& input, int factor) {
  const OIIO::ImageSpec spec = input.spec();
  const int channels = spec.nchannels >= 3 ? 3 : 1;
  DecodedImage image{std::max(1, spec.width / factor), std::max(1, spec.height / factor), {}};
  const int rows_at_once = spec.tile_width > 0 ? spec.height : factor;
  const auto stride = static_cast<std::size_t>(spec.width) * static_cast<std::size_t>(channels);
  std::vector<std::uint8_t> rows(stride * static_cast<std::size_t>(rows_at_once));
  image.samples.resize(3 * static_cast<std::size_t>(image.width) *
                       static_cast<std::size_t>(image.height));
  std::byte* out = image.samples.data();
  for (int y = 0; y < image.height; ++y) {
    const int first = y * factor;
    const int last = std::min(spec.height, first + factor);
    if (spec.tile_width > 0) {
      if (y == 0 && !input.read_image(0, 0, 0, channels, OIIO::TypeDesc::UINT8, rows.data())) {
        throw std::runtime_error(input.geterror());
      }
    } else if (!input.read_scanlines(0, 0, spec.y + first, spec.y + last, 0, 0, channels,
                                     OIIO::TypeDesc::UINT8, rows.data())) {
      throw std::runtime_error(input.geterror());
    }
    const std::size_t base = spec.tile_width > 0 ? static_cast<std::size_t>(first) : 0;
    for (int x = 0; x < image.width; ++x) {
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
        *out++ = static_cast<std::byte>((sum + count / 2) / count);
      }
    }
  }
  return image;
}

}  // namespace

DecodedImage decode_image(const ImageRequest& request, std::span<const std::byte> content) {
  // A thread for each core would take of the memory and the seconds that one image has.
  OIIO::attribute("threads", 1);
  OIIO::attribute("exr_threads", 1);
  const Open open = open_image(request, content);
  const OIIO::ImageSpec& spec = open.input->spec();
  if (spec.width < 1 || spec.height < 1 || std::int64_t{spec.width} * spec.height > kMostPixels) {
    throw std::runtime_error("has no pixels, or more than 2^31");
  }
  if (spec.depth > 1) throw std::runtime_error("is a volume of several layers, not one image");
  if (request.wish == ImageWish::kSize) return {spec.width, spec.height, {}};
  if (request.wish == ImageWish::kGray) return decode_gray(*open.input);
  return decode_color(*open.input, static_cast<int>(request.factor));
}

}  // namespace binderjet
