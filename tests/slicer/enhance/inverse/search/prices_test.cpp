// SPDX-License-Identifier: GPL-3.0-or-later
// What printed voxels cost.
#include "slicer/enhance/inverse/search/prices.h"

#include <gtest/gtest.h>

#include "tests/support/inverse_scene.h"
#include "tests/support/random.h"
#include "tests/support/rows.h"

namespace binderjet {
namespace {

using whole::Random;

TEST(Prices, AreTheSlicesOfPowderLessThoseOfSolid) {
  // Voxels 2 and 3 are solid in both slices, 4 and 5 in one.
  const VoxelLayer target{{rows_of(8, {{2, 6}}), rows_of(8, {{2, 4}})}};
  const Band band(rows_of(8, {{0, 8}}), Rect{0, 0, 1, 1}, {1, 1});
  constexpr int kTwo = 2 * kPriceUnit;
  EXPECT_EQ(voxel_prices(target, band),
            (std::vector<std::int16_t>{kTwo, kTwo, -kTwo, -kTwo, 0, 0, kTwo, kTwo}));
}

TEST(Prices, AreOfTheBandsVoxelsAndBeyondTheLayerOfPowder) {
  Random random;
  for (int round = 0; round < 50; ++round) {
    SCOPED_TRACE(round);
    const int slices = random.number(1, 3);
    const whole::Volume target = random.volume(random.number(1, 20), random.number(1, 20), slices);
    const auto layer = whole::voxel_stream(target, slices, {0, 1})->next(1).front();
    const RunLayer open = whole::slice(random.volume(target.nx, target.ny, 1), 0);
    const Band band(open, Rect{-2, -1, random.number(-1, 3), random.number(0, 4)}, {1, 1});
    const auto prices = voxel_prices(*layer, band);
    ASSERT_EQ(prices.size(), band.size());
    for (int y = band.first_row(); y < band.last_row(); ++y) {
      for (const BandRun& run : band.row(y)) {
        for (int x = run.x0; x < run.x1; ++x) {
          int expected = 0;
          for (int z = 0; z < slices; ++z) {
            expected += target.at(x, y, z) == 1 ? -kPriceUnit : kPriceUnit;
          }
          ASSERT_EQ(prices[band.number(x, y)], expected) << x << ", " << y;
        }
      }
    }
  }
}

}  // namespace
}  // namespace binderjet
