// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/stack/gray_png.h"

#include <png.h>

#include <cstdio>
#include <memory>
#include <stdexcept>

#include "slicer/images/message.h"

namespace binderjet {
namespace {

struct Reader {
  Reader() {
    png = png_create_read_struct(PNG_LIBPNG_VER_STRING, nullptr, fail, ignore);
    if (png != nullptr) info = png_create_info_struct(png);
    if (info == nullptr) throw std::bad_alloc();
  }
  ~Reader() { png_destroy_read_struct(&png, &info, nullptr); }
  Reader(const Reader&) = delete;
  Reader& operator=(const Reader&) = delete;

  // Through libpng's C frames, which hold nothing that needs to be destroyed here.
  [[noreturn]] static void fail(png_structp, png_const_charp what) {
    throw std::runtime_error(what);
  }
  static void ignore(png_structp, png_const_charp) {}

  png_structp png = nullptr;
  png_infop info = nullptr;
};

bool is_plain_gray(const Reader& reader) {
  return png_get_color_type(reader.png, reader.info) == PNG_COLOR_TYPE_GRAY &&
         png_get_bit_depth(reader.png, reader.info) <= 8 &&
         png_get_valid(reader.png, reader.info, PNG_INFO_tRNS) == 0;
}

}  // namespace

std::optional<std::vector<std::uint8_t>> read_gray_png(const std::string& path, int width,
                                                       int height) {
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rb"),
                                                             std::fclose);
  if (file == nullptr) return std::nullopt;
  try {
    const Reader reader;
    png_init_io(reader.png, file.get());
    png_read_info(reader.png, reader.info);
    const auto columns = static_cast<std::size_t>(width);
    const auto rows = static_cast<std::size_t>(height);
    if (!is_plain_gray(reader) || std::int64_t{width} * height > kMostPixels ||
        png_get_image_width(reader.png, reader.info) != columns ||
        png_get_image_height(reader.png, reader.info) != rows) {
      return std::nullopt;
    }
    png_set_expand_gray_1_2_4_to_8(reader.png);
    const int passes = png_set_interlace_handling(reader.png);
    png_read_update_info(reader.png, reader.info);
    std::vector<std::uint8_t> samples(columns * rows);
    for (int pass = 0; pass < passes; ++pass) {
      for (std::size_t y = 0; y < rows; ++y) {
        png_read_row(reader.png, samples.data() + y * columns, nullptr);
      }
    }
    png_read_end(reader.png, nullptr);
    return samples;
  } catch (const std::runtime_error&) {
    return std::nullopt;
  }
}

}  // namespace binderjet
