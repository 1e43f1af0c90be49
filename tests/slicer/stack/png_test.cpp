// SPDX-License-Identifier: GPL-3.0-or-later
// Our PNGs are read back with libpng, which did not write them.
#include "slicer/stack/png.h"

#include <gtest/gtest.h>
#include <pthread.h>
#include <sys/mman.h>

#include <cstdint>
#include <functional>
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

// Runs `work` in a thread whose stack lies anywhere in memory.
void run_anywhere(std::mt19937_64& random, std::function<void()> work) {
  constexpr std::size_t kStack = std::size_t{1} << 20;
  const std::uintptr_t wish = random() % (std::uintptr_t{1} << 46) / kStack * kStack;
  void* stack = mmap(reinterpret_cast<void*>(wish), kStack, PROT_READ | PROT_WRITE,
                     MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  ASSERT_NE(stack, MAP_FAILED);
  pthread_attr_t with_stack;
  pthread_attr_init(&with_stack);
  pthread_attr_setstack(&with_stack, stack, kStack);
  pthread_t thread{};
  const auto begin = [](void* it) -> void* {
    (*static_cast<std::function<void()>*>(it))();
    return nullptr;
  };
  ASSERT_EQ(pthread_create(&thread, &with_stack, begin, &work), 0);
  pthread_join(thread, nullptr);
  pthread_attr_destroy(&with_stack);
  munmap(stack, kStack);
}

// A compressor that takes an address of its own for data gives other bytes once in a thousand.
TEST(Png, HasTheSameBytesWhereverItIsMade) {
  std::vector<std::byte> bits(77 * 7);
  for (std::size_t y = 5; y < 77; y += 9) {
    for (std::size_t x = 0; x < 7; ++x) bits[y * 7 + x] = static_cast<std::byte>(x * 37 + y);
  }
  const auto encoded = [&bits] { return encode_png_mask(bits, 56, 77, {0.1, 0.1}); };
  const std::vector<std::byte> first = encoded();
  const unsigned seed = std::random_device()();
  SCOPED_TRACE(seed);
  std::mt19937_64 random(seed);
  int others = 0;
  for (int i = 0; i < 3000; ++i) run_anywhere(random, [&] { others += encoded() != first; });
  EXPECT_EQ(others, 0);
}

}  // namespace
}  // namespace binderjet
