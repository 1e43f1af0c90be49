// SPDX-License-Identifier: GPL-3.0-or-later
// PNGs as libpng reads them, which did not write them.
#pragma once

#include <gtest/gtest.h>
#include <png.h>

#include <cstddef>
#include <cstring>
#include <span>
#include <vector>

namespace binderjet::png {

struct Decoded {
  int width = 0;
  int height = 0;
  int bit_depth = 0;
  int color_type = 0;
  png_uint_32 per_meter_x = 0;
  png_uint_32 per_meter_y = 0;
  std::vector<std::byte> bits;  // the rows as they lie in the file, without filters
};

inline Decoded decode(std::span<const std::byte> file) {
  Decoded out;
  png_structp png = png_create_read_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png_create_info_struct(png);
  const std::byte* next = file.data();
  if (setjmp(png_jmpbuf(png)) != 0) {
    ADD_FAILURE() << "libpng refuses the file";
    png_destroy_read_struct(&png, &info, nullptr);
    return {};
  }
  png_set_read_fn(png, &next, [](png_structp p, png_bytep to, png_size_t size) {
    auto* from = static_cast<const std::byte**>(png_get_io_ptr(p));
    std::memcpy(to, *from, size);
    *from += size;
  });
  png_read_png(png, info, PNG_TRANSFORM_IDENTITY, nullptr);
  out.width = static_cast<int>(png_get_image_width(png, info));
  out.height = static_cast<int>(png_get_image_height(png, info));
  out.bit_depth = png_get_bit_depth(png, info);
  out.color_type = png_get_color_type(png, info);
  out.per_meter_x = png_get_x_pixels_per_meter(png, info);
  out.per_meter_y = png_get_y_pixels_per_meter(png, info);
  const std::size_t stride = png_get_rowbytes(png, info);
  png_bytepp rows = png_get_rows(png, info);
  for (int y = 0; y < out.height; ++y) {
    const auto* row = reinterpret_cast<const std::byte*>(rows[y]);
    out.bits.insert(out.bits.end(), row, row + stride);
    // libpng leaves the bits behind the last pixel as they were in memory.
    if (out.width % 8 != 0) out.bits.back() &= static_cast<std::byte>(0xff00 >> (out.width % 8));
  }
  png_destroy_read_struct(&png, &info, nullptr);
  return out;
}

}  // namespace binderjet::png
