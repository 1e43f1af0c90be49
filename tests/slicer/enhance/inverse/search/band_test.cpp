// SPDX-License-Identifier: GPL-3.0-or-later
// The voxels near open pixels, numbered without a gap.
#include "slicer/enhance/inverse/search/band.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/support/random.h"
#include "tests/support/rows.h"

namespace binderjet {
namespace {

using whole::Random;

TEST(Band, JoinsWhatTwoPixelsReach) {
  // Pixels 1 and 3 of 2 voxels each, which reach one voxel to each side: 1 to 4 and 5 to 8.
  const Band band(rows_of(6, {{}, {1, 2, 3, 4}}), Rect{-1, 0, 3, 2}, {2, 2});
  EXPECT_EQ(band.first_row(), 2);
  EXPECT_EQ(band.last_row(), 4);
  ASSERT_EQ(band.row(2).size(), 1U);
  EXPECT_EQ(band.row(2)[0].x0, 1);
  EXPECT_EQ(band.row(2)[0].x1, 9);
  EXPECT_EQ(band.number(1, 3), 8U);
  EXPECT_EQ(band.size(), 16U);
  EXPECT_TRUE(band.row(1).empty());
  EXPECT_TRUE(band.row(4).empty());
}

TEST(Band, IsEmptyWithoutOpenPixels) {
  const Band band(RunLayer::powder(5, 4), Rect{-1, -1, 3, 3}, {2, 2});
  EXPECT_EQ(band.size(), 0U);
  EXPECT_TRUE(band.row(0).empty());
}

TEST(Band, HoldsAllThatOpenPixelsReachAndNothingElse) {
  Random random;
  for (int round = 0; round < 100; ++round) {
    SCOPED_TRACE(round);
    const int nx = random.number(1, 12);
    const int ny = random.number(1, 12);
    const int rx = random.number(1, 3);
    const int ry = random.number(1, 3);
    const RunLayer open = whole::slice(random.volume(nx, ny, 1), 0);
    const int x0 = random.number(-6, 3);
    const int y0 = random.number(-6, 3);
    const Rect reach{x0, y0, x0 + rx + random.number(0, 9), y0 + random.number(1, 9)};
    const Band band(open, reach, {rx, ry});
    std::size_t next = 0;
    for (int y = -10; y < ny * ry + 20; ++y) {
      for (int x = -10; x < nx * rx + 20; ++x) {
        bool reached = false;
        for (int j = 0; j < ny; ++j) {
          for (int i = 0; i < nx; ++i) {
            reached = reached || (open.at(i, j) && reach.holds(x - i * rx, y - j * ry));
          }
        }
        const auto row = band.row(y);
        ASSERT_EQ(reached,
                  std::any_of(row.begin(), row.end(),
                              [x](const BandRun& run) { return run.x0 <= x && x < run.x1; }))
            << x << ", " << y;
        if (reached) {
          ASSERT_EQ(band.number(x, y), next++);
        }
      }
    }
    ASSERT_EQ(band.size(), next);
  }
}

}  // namespace
}  // namespace binderjet
