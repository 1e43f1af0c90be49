// SPDX-License-Identifier: GPL-3.0-or-later
// Our PNGs are read back with libpng, which did not write them.
#include "slicer/stack/png.h"

#include <gtest/gtest.h>

#include <random>

#include "slicer/layers/run_layer.h"
#include "tests/support/decoded_png.h"

namespace binderjet {
namespace {

TEST(Png, IsOneBitGrayWithTheTrueResolution) {
  const std::vector<std::byte> bits(2 * 3, std::byte{0xa0});
  const png::Decoded png = png::decode(encode_png_mask(bits, 11, 3, {25.4 / 300, 25.4 / 450}));
  EXPECT_EQ(png.bit_depth, 1);
  EXPECT_EQ(png.color_type, PNG_COLOR_TYPE_GRAY);
  EXPECT_EQ(png.width, 11);
  EXPECT_EQ(png.height, 3);
  EXPECT_EQ(png.per_meter_x, 11811U);  // 300 dpi
  EXPECT_EQ(png.per_meter_y, 17717U);  // 450 dpi
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
      EXPECT_EQ(png::decode(encode_png_mask(bits, width, height, {0.1, 0.1})).bits, bits);
    }
  }
}

}  // namespace
}  // namespace binderjet
