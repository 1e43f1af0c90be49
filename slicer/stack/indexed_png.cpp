// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/stack/indexed_png.h"

#include <png.h>

#include <cassert>
#include <cmath>
#include <memory>
#include <stdexcept>

namespace binderjet {
namespace {

struct Writer {
  Writer() {
    png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, fail, nullptr);
    if (png != nullptr) info = png_create_info_struct(png);
    if (info == nullptr) throw std::bad_alloc();
  }
  ~Writer() { png_destroy_write_struct(&png, &info); }
  Writer(const Writer&) = delete;
  Writer& operator=(const Writer&) = delete;

  // Through libpng's C frames, which hold nothing that needs to be destroyed here.
  [[noreturn]] static void fail(png_structp, png_const_charp what) { throw std::logic_error(what); }

  png_structp png = nullptr;
  png_infop info = nullptr;
};

void append(png_structp png, png_bytep data, png_size_t size) {
  auto& out = *static_cast<std::vector<std::byte>*>(png_get_io_ptr(png));
  const auto* bytes = reinterpret_cast<const std::byte*>(data);
  out.insert(out.end(), bytes, bytes + size);
}

}  // namespace

std::vector<std::byte> encode_indexed_png(std::span<const std::uint8_t> pixels, int width,
                                          int height, std::span<const Rgb> palette,
                                          std::array<double, 2> pitch_mm) {
  assert(pixels.size() == static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  assert(palette.size() <= 16);
  std::vector<std::byte> out;
  Writer writer;
  png_set_write_fn(writer.png, &out, append, nullptr);
  png_set_compression_level(writer.png, 1);
  png_set_filter(writer.png, 0, PNG_FILTER_UP);
  png_set_IHDR(writer.png, writer.info, static_cast<png_uint_32>(width),
               static_cast<png_uint_32>(height), 4, PNG_COLOR_TYPE_PALETTE, PNG_INTERLACE_NONE,
               PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  std::vector<png_color> colors;
  for (const Rgb& c : palette) colors.push_back({c[0], c[1], c[2]});
  png_set_PLTE(writer.png, writer.info, colors.data(), static_cast<int>(colors.size()));
  png_set_pHYs(writer.png, writer.info, static_cast<png_uint_32>(std::lround(1000 / pitch_mm[0])),
               static_cast<png_uint_32>(std::lround(1000 / pitch_mm[1])), PNG_RESOLUTION_METER);
  png_write_info(writer.png, writer.info);
  png_set_packing(writer.png);
  for (int y = 0; y < height; ++y) {
    png_write_row(writer.png, pixels.data() + static_cast<std::ptrdiff_t>(y) * width);
  }
  png_write_end(writer.png, nullptr);
  return out;
}

}  // namespace binderjet
