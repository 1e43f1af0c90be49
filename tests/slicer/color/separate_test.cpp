// SPDX-License-Identifier: GPL-3.0-or-later
// Drops of ink: as many as the tone asks for, nowhere on paper, without a repeating pattern.
#include "slicer/color/separate.h"

#include <gtest/gtest.h>

#include <cmath>

namespace binderjet {
namespace {

std::vector<std::byte> flat(int width, int height, unsigned char level) {
  return std::vector<std::byte>(
      3 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height), std::byte{level});
}

TEST(Separate, PutsAsManyDropsAsTheToneAsksFor) {
  for (const int level : {250, 230, 200, 128, 64, 10, 0}) {
    const auto planes =
        separate_cmy(flat(200, 200, static_cast<unsigned char>(level)), 200, 200, 3);
    for (const RunLayer& plane : planes) {
      EXPECT_NEAR(static_cast<double>(plane.count()) / 40000, (255 - level) / 255.0, 0.01) << level;
    }
  }
}

TEST(Separate, PutsNoDropOnPaper) {
  auto rgb = flat(64, 64, 255);
  for (int y = 20; y < 40; ++y) {
    for (int x = 20; x < 40; ++x) rgb[static_cast<std::size_t>(3 * (64 * y + x))] = std::byte{90};
  }
  const auto planes = separate_cmy(rgb, 64, 64, 0);
  EXPECT_GT(planes[0].count(), 0);
  EXPECT_EQ(planes[1].count(), 0);
  EXPECT_EQ(planes[2].count(), 0);
  for (int y = 0; y < 64; ++y) {
    for (int x = 0; x < 64; ++x) {
      const bool paper = x < 20 || x >= 40 || y < 20 || y >= 40;
      ASSERT_FALSE(paper && planes[0].at(x, y));
    }
  }
}

TEST(Separate, WhitensAllButTheMask) {
  RunLayer mask(8);
  for (const std::vector<int>& row : {std::vector<int>{}, {0, 3, 5, 8}, {2, 4}})
    mask.append_row(row);
  auto rgb = flat(8, 3, 90);
  whiten_outside(mask, rgb);
  for (int y = 0; y < 3; ++y) {
    for (int x = 0; x < 8; ++x) {
      for (int c = 0; c < 3; ++c) {
        EXPECT_EQ(rgb[static_cast<std::size_t>(3 * (8 * y + x) + c)],
                  mask.at(x, y) ? std::byte{90} : std::byte{255});
      }
    }
  }
}

TEST(Separate, EvenToneStartsWithoutASeam) {
  // Plain error diffusion leaves the first rows of a light tone empty.
  const auto planes = separate_cmy(flat(400, 40, 240), 400, 40, 1);
  std::int64_t first_rows = 0;
  for (int y = 0; y < 6; ++y) {
    for (int x = 0; x < 400; ++x) first_rows += planes[0].at(x, y) ? 1 : 0;
  }
  const double wanted = 6 * 400 * 15 / 255.0;
  EXPECT_GT(static_cast<double>(first_rows), 0.5 * wanted);
  EXPECT_LT(static_cast<double>(first_rows), 1.6 * wanted);
}

TEST(Separate, NoTwoLayersRepeatEachOther) {
  const auto rgb = flat(100, 100, 200);
  EXPECT_NE(separate_cmy(rgb, 100, 100, 1)[0], separate_cmy(rgb, 100, 100, 2)[0]);
  EXPECT_EQ(separate_cmy(rgb, 100, 100, 1)[0], separate_cmy(rgb, 100, 100, 1)[0]);
}

}  // namespace
}  // namespace binderjet
