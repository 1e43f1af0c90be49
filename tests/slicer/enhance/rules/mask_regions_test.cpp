// SPDX-License-Identifier: GPL-3.0-or-later
// The smallest island and hole against a flood of the whole mask.
#include "slicer/enhance/rules/mask_regions.h"

#include <gtest/gtest.h>

#include "tests/support/mask_regions.h"
#include "tests/support/random.h"

namespace binderjet {
namespace {

TEST(MaskRegions, TakeABayForPowderAndAPondForAHole) {
  RunLayer mask(8);
  mask.append_row(std::vector<int>{0, 4});
  mask.append_row(std::vector<int>{0, 1, 3, 4});  // a pond of two pixels
  mask.append_row(std::vector<int>{1, 4, 6, 7});  // a bay at the side, an island of one
  mask.append_row(std::vector<int>{0, 4});
  EXPECT_EQ(mask_regions(mask).smallest_hole_px, 2);
  EXPECT_EQ(mask_regions(mask).smallest_island_px, 1);
}

TEST(MaskRegions, AreThoseOfAFlood) {
  whole::Random random;
  for (int round = 0; round < 200; ++round) {
    SCOPED_TRACE(round);
    const RunLayer mask =
        whole::slice(random.volume(random.number(1, 20), random.number(1, 20), 1), 0);
    const MaskRegions flooded = whole::mask_regions(mask);
    ASSERT_EQ(mask_regions(mask).smallest_island_px, flooded.smallest_island_px);
    ASSERT_EQ(mask_regions(mask).smallest_hole_px, flooded.smallest_hole_px);
  }
}

}  // namespace
}  // namespace binderjet
