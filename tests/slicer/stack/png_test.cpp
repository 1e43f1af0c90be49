// SPDX-License-Identifier: GPL-3.0-or-later
// Our PNGs are read back with libpng, which did not write them.
#include "slicer/stack/png.h"

#include <gtest/gtest.h>
#include <png.h>

#include <cstring>
#include <random>

#include "slicer/run_layer.h"

namespace binderjet {
namespace {

struct Decoded {
  int width = 0;
  int height = 0;
  int bit_depth = 0;
  int color_type = 0;
  png_uint_32 per_metre_x = 0;
  png_uint_32 per_metre_y = 0;
  std::vector<std::byte> bits;
};

Decoded decode(const std::vector<std::byte>& file) {
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
  out.per_metre_x = png_get_x_pixels_per_meter(png, info);
  out.per_metre_y = png_get_y_pixels_per_meter(png, info);
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

TEST(Png, IsOneBitGreyWithTheTrueResolution) {
  const std::vector<std::byte> bits(2 * 3, std::byte{0xa0});
  const Decoded png = decode(encode_png_mask(bits, 11, 3, {25.4 / 300, 25.4 / 450}));
  EXPECT_EQ(png.bit_depth, 1);
  EXPECT_EQ(png.color_type, PNG_COLOR_TYPE_GRAY);
  EXPECT_EQ(png.width, 11);
  EXPECT_EQ(png.height, 3);
  EXPECT_EQ(png.per_metre_x, 11811U);  // 300 dpi
  EXPECT_EQ(png.per_metre_y, 17717U);  // 450 dpi
}

TEST(Png, LibpngReadsBackEveryBit) {
  const unsigned seed = std::random_device()();
  RecordProperty("seed", std::to_string(seed));
  SCOPED_TRACE(seed);
  std::mt19937 random(seed);
  for (const auto& [width, height] : {std::pair{1, 1}, {8, 2}, {1237, 311}, {4803, 997}}) {
    for (const unsigned density : {0U, 1U, 200U}) {
      const std::size_t stride = packed_row_bytes(width);
      std::vector<std::byte> bits(stride * static_cast<std::size_t>(height));
      for (std::size_t i = 0; i < bits.size(); ++i) {
        if (random() % 256 < density) bits[i] = static_cast<std::byte>(random());
        if (i % stride == stride - 1 && width % 8 != 0) {
          bits[i] &= static_cast<std::byte>(0xff00 >> (width % 8));
        }
      }
      EXPECT_EQ(decode(encode_png_mask(bits, width, height, {0.1, 0.1})).bits, bits);
    }
  }
}

}  // namespace
}  // namespace binderjet
