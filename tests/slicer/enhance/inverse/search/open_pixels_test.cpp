// SPDX-License-Identifier: GPL-3.0-or-later
// The pixels near a boundary.
#include "slicer/enhance/inverse/search/open_pixels.h"

#include <gtest/gtest.h>

#include "tests/support/random.h"
#include "tests/support/rows.h"

namespace binderjet {
namespace {

using whole::Random;

TEST(OpenPixels, AreThoseBesideAnEdgeAndUnderAStep) {
  const Grid grid{{0.1, 0.1, 0.1}, {2, 1, 2}};
  // Pixels 2 to 7 are solid below and 2 to 4 above.
  const VoxelLayer target{{rows_of(20, {{4, 16}}), rows_of(20, {{4, 10}})}};
  EXPECT_EQ(open_pixels(target, grid, 0), rows_of(10, {{5, 8}}));
  EXPECT_EQ(open_pixels(target, grid, 1), rows_of(10, {{1, 3, 4, 9}}));
}

TEST(OpenPixels, AreNoneInAWholeLayer) {
  const Grid grid{{0.1, 0.1, 0.1}, {2, 2, 1}};
  EXPECT_TRUE(open_pixels({{rows_of(8, {{0, 8}, {0, 8}})}}, grid, 3).empty());
  EXPECT_TRUE(open_pixels({{RunLayer::powder(8, 2)}}, grid, 3).empty());
}

TEST(OpenPixels, AreWithinReachOfBothStates) {
  Random random;
  for (int round = 0; round < 50; ++round) {
    SCOPED_TRACE(round);
    const Grid grid = random.grid();
    const auto [rx, ry, rz] = grid.detail_vx;
    const int nx = random.number(1, 12);
    const int ny = random.number(1, 12);
    const int reach = random.number(0, 3);
    const whole::Volume target = random.volume(nx * rx, ny * ry, rz);
    // Whether a voxel of pixel (i, j) has this state.
    const auto has = [&, rx = rx, ry = ry, rz = rz](int i, int j, int state) {
      for (int z = 0; z < rz; ++z)
        for (int y = j * ry; y < (j + 1) * ry; ++y)
          for (int x = i * rx; x < (i + 1) * rx; ++x)
            if (target.at(x, y, z) == state) return true;
      return false;
    };
    const auto layer = whole::voxel_stream(target, rz, {0, 1})->next(1).front();
    const RunLayer open = open_pixels(*layer, grid, reach);
    for (int y = 0; y < ny; ++y) {
      for (int x = 0; x < nx; ++x) {
        bool near[2] = {false, false};
        for (int j = std::max(0, y - reach); j <= std::min(ny - 1, y + reach); ++j)
          for (int i = std::max(0, x - reach); i <= std::min(nx - 1, x + reach); ++i)
            for (const int state : {0, 1}) near[state] = near[state] || has(i, j, state);
        ASSERT_EQ(open.at(x, y), near[0] && near[1]) << x << ", " << y;
      }
    }
  }
}

TEST(OpenPixels, GrowAlongBothAxesAndStayInTheLayer) {
  const RunLayer one = rows_of(6, {{}, {}, {1, 2}, {}});
  EXPECT_EQ(grown(one, 1), rows_of(6, {{}, {0, 3}, {0, 3}, {0, 3}}));
  EXPECT_EQ(grown(one, 2), rows_of(6, {{0, 4}, {0, 4}, {0, 4}, {0, 4}}));
}

}  // namespace
}  // namespace binderjet
