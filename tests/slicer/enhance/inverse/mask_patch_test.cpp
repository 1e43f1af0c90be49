// SPDX-License-Identifier: GPL-3.0-or-later
// Pieces of one mask put into another.
#include "slicer/enhance/inverse/mask_patch.h"

#include <gtest/gtest.h>

#include <array>

#include "slicer/enhance/inverse/search/layer_sets.h"
#include "slicer/enhance/rules/mask_regions.h"
#include "tests/support/random.h"
#include "tests/support/rows.h"

namespace binderjet {
namespace {

TEST(MaskPatch, PlacesAreThePixelsOfTheVoxelsAndWhatIsAroundThem) {
  const Grid grid{{0.1, 0.1, 0.1}, {2, 3, 2}};
  RunLayer voxels(16);
  for (int y = 0; y < 9; ++y)
    voxels.append_row(y == 4 ? std::vector<int>{5, 8} : std::vector<int>{});
  const std::vector<Rect> places = pixels_around(voxels, grid, 1);
  ASSERT_EQ(places.size(), 1U);
  EXPECT_EQ(places[0].x0, 1);
  EXPECT_EQ(places[0].x1, 5);
  EXPECT_EQ(places[0].y0, 0);
  EXPECT_EQ(places[0].y1, 3);
}

TEST(MaskPatch, TakesTheOthersPixelsThereAndItsOwnElsewhere) {
  const RunLayer mask = rows_of(8, {{0, 8}, {0, 8}, {0, 8}});
  const RunLayer with = rows_of(8, {{0, 1}, {}, {}});
  const std::array places{Rect{-3, 0, 3, 2}};
  EXPECT_EQ(patched(mask, with, places, {}), rows_of(8, {{0, 1, 3, 8}, {3, 8}, {0, 8}}));
}

TEST(MaskPatch, ObeysTheRules) {
  const RunLayer mask = rows_of(8, {{0, 8}, {0, 8}, {0, 8}});
  const RunLayer with = rows_of(8, {{0, 1}, {}, {}});
  const std::array places{Rect{0, 0, 3, 3}};
  // The island of one pixel goes.
  EXPECT_EQ(patched(mask, with, places, {4, 4}), rows_of(8, {{3, 8}, {3, 8}, {3, 8}}));
}

TEST(MaskPatch, ObeysTheRulesEverywhereAndChangesNothingFarOff) {
  whole::Random random;
  for (int round = 0; round < 300; ++round) {
    SCOPED_TRACE(round);
    const int width = random.number(4, 40);
    const int height = random.number(4, 40);
    const MaskRules rules{random.number(1, 5), random.number(1, 5)};
    const RunLayer nothing = RunLayer::powder(width, height);
    const std::array everywhere{Rect{0, 0, width, height}};
    const auto any = [&] { return whole::slice(random.volume(width, height, 1, 4), 0); };
    const RunLayer mask = patched(nothing, any(), everywhere, rules);
    const int x = random.number(-3, width);
    const int y = random.number(-3, height);
    const std::array places{Rect{x, y, x + random.number(0, 9), y + random.number(0, 9)}};
    const RunLayer out = patched(mask, any(), places, rules);
    const MaskRegions found = mask_regions(out);
    ASSERT_GE(found.smallest_hole_px, rules.min_hole_px);
    ASSERT_GE(found.smallest_island_px, rules.min_island_px);
    const std::array near{places[0].grown(2 * rules.largest_px(), 2 * rules.largest_px())};
    ASSERT_EQ(without(out, within(out, near)), without(mask, within(mask, near)));
  }
}

}  // namespace
}  // namespace binderjet
