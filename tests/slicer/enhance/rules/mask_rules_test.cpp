// SPDX-License-Identifier: GPL-3.0-or-later
// Masks without islands and holes that are too small.
#include "slicer/enhance/rules/mask_rules.h"

#include <gtest/gtest.h>

#include "tests/support/mask_regions.h"
#include "tests/support/random.h"

namespace binderjet {
namespace {

using whole::Random;

Plane<std::uint8_t> plane_of(const RunLayer& layer, int margin) {
  Plane<std::uint8_t> plane(Rect{0, 0, layer.width(), layer.height()}.grown(margin, margin));
  add_layer(layer, std::uint8_t{1}, plane);
  return plane;
}

TEST(MaskRules, FillSmallHolesAndEraseSmallIslands) {
  Plane<std::uint8_t> mask(Rect{-4, -4, 14, 10});
  for (int y = 0; y < 5; ++y)
    for (int x = 0; x < 6; ++x) *mask.at(x, y) = 1;
  *mask.at(2, 2) = 0;  // a hole of one pixel
  *mask.at(9, 1) = 1;  // an island of two
  *mask.at(9, 2) = 1;
  obey({3, 2}, {0, 0, 10, 6}, mask);
  EXPECT_EQ(*mask.at(2, 2), 1);
  EXPECT_EQ(*mask.at(9, 1), 0);
  EXPECT_EQ(*mask.at(9, 2), 0);
  EXPECT_EQ(*mask.at(0, 0), 1);
}

TEST(MaskRules, PixelsThatMeetAtACornerOnlyDoNotHangTogether) {
  Plane<std::uint8_t> mask(Rect{-4, -4, 8, 8});
  *mask.at(1, 1) = 1;
  *mask.at(2, 2) = 1;
  obey({2, 1}, {0, 0, 4, 4}, mask);
  EXPECT_EQ(*mask.at(1, 1), 0);
  EXPECT_EQ(*mask.at(2, 2), 0);
}

TEST(MaskRules, LeaveNothingThatIsTooSmall) {
  Random random;
  for (int round = 0; round < 200; ++round) {
    SCOPED_TRACE(round);
    const MaskRules rules{random.number(1, 7), random.number(1, 7)};
    const whole::Volume noise = random.volume(random.number(1, 20), random.number(1, 20), 1);
    Plane<std::uint8_t> mask = plane_of(whole::slice(noise, 0), rules.largest_px());
    obey(rules, {0, 0, noise.nx, noise.ny}, mask);
    const MaskRegions found = whole::mask_regions(to_layer(mask, noise.nx, noise.ny));
    ASSERT_GE(found.smallest_island_px, rules.min_island_px);
    ASSERT_GE(found.smallest_hole_px, rules.min_hole_px);
  }
}

TEST(MaskRules, LeaveAWholeMaskAsTheyLeaveItsPixels) {
  Random random;
  RuleChanges sum;
  for (int round = 0; round < 400; ++round) {
    SCOPED_TRACE(round);
    // Also masks of a few pixels with a minimum that is larger than all of them.
    const MaskRules rules{random.number(1, 40), random.number(1, 40)};
    const whole::Volume noise = random.volume(random.number(1, 30), random.number(1, 30), 1);
    const RunLayer mask = whole::slice(noise, 0);
    Plane<std::uint8_t> pixels = plane_of(mask, rules.largest_px());
    obey(rules, {0, 0, noise.nx, noise.ny}, pixels);
    const ObeyingMask obeying = obeying_mask(mask, rules);
    ASSERT_EQ(obeying.mask, to_layer(pixels, noise.nx, noise.ny));
    ASSERT_EQ(obeying.changes.any(), obeying.mask != mask);
    sum.islands_erased += obeying.changes.islands_erased;
    sum.holes_filled += obeying.changes.holes_filled;
  }
  EXPECT_GT(sum.islands_erased, 0);
  EXPECT_GT(sum.holes_filled, 0);
}

TEST(MaskRules, CountWhatTheyEraseAndFill) {
  RunLayer mask(12);
  mask.append_row(std::vector<int>{0, 5, 7, 8, 10, 11});
  mask.append_row(std::vector<int>{0, 1, 2, 3, 4, 5, 7, 8});  // two holes of a pixel, side by side
  mask.append_row(std::vector<int>{0, 5});
  const ObeyingMask obeying = obeying_mask(mask, {3, 2});
  EXPECT_EQ(obeying.changes, (RuleChanges{2, 2}));
  EXPECT_EQ(obeying.mask.count(), 15);
  EXPECT_EQ(obeying_mask(mask, {1, 1}).mask, mask);
}

TEST(MaskRules, CheckAroundAFlipSeesAllThatItCanBreak) {
  Random random;
  int refused = 0;
  for (int round = 0; round < 300; ++round) {
    SCOPED_TRACE(round);
    const MaskRules rules{random.number(1, 5), random.number(1, 5)};
    const whole::Volume noise = random.volume(random.number(1, 12), random.number(1, 12), 1);
    Plane<std::uint8_t> mask = plane_of(whole::slice(noise, 0), rules.largest_px());
    obey(rules, {0, 0, noise.nx, noise.ny}, mask);
    const int x = random.number(0, noise.nx - 1);
    const int y = random.number(0, noise.ny - 1);
    *mask.at(x, y) ^= 1;
    const MaskRegions found = whole::mask_regions(to_layer(mask, noise.nx, noise.ny));
    const bool fits = found.smallest_island_px >= rules.min_island_px &&
                      found.smallest_hole_px >= rules.min_hole_px;
    ASSERT_EQ(RuleCheck(rules).fits_around(mask, x, y), fits);
    refused += static_cast<int>(!fits);
  }
  EXPECT_GT(refused, 0);
}

}  // namespace
}  // namespace binderjet
