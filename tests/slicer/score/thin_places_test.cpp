// SPDX-License-Identifier: GPL-3.0-or-later
// Thin places by hand: voxels and layers of 0.1 mm and a rule of 1.5 mm, so a cell is one voxel and
// a ball needs 15 of them.
#include "slicer/score/thin_places.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "tests/support/vector_stream.h"

namespace binderjet {
namespace {

const Grid kGrid{{0.1, 0.1, 0.1}, {1, 1, 1}};
constexpr double kRule = 1.5;

// What is thin in the box of this size where `is(x, y, z)` is the part.
template <class Is>
std::vector<ThinPlace> thin(std::array<int, 3> size, Is is, Matter matter = Matter::kPart) {
  std::vector<Shared<VoxelLayer>> layers;
  for (int z = 0; z < size[2]; ++z) {
    RunLayer slice(size[0]);
    for (int y = 0; y < size[1]; ++y) slice.append_row_where([&](int x) { return is(x, y, z); });
    layers.push_back(std::make_shared<const VoxelLayer>(VoxelLayer{{slice}}));
  }
  std::vector<ThinPlace> found;
  find_thin_places({"voxels", {0, size[2]}, stream_of(layers)}, kGrid, kRule, matter, {},
                   [&](const ThinPlace& place) { found.push_back(place); });
  return found;
}

TEST(ThinPlaces, AreNoneInABlockWithItsEdgesAndCorners) {
  EXPECT_TRUE(thin({30, 30, 30}, [](int, int, int) { return true; }).empty());
}

// A wall of 20 x 25 voxels, n thick along each axis in turn.
TEST(ThinPlaces, AreWallsBelowTheRuleAndNotThoseAtItOrAbove) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    SCOPED_TRACE(axis);
    const auto wall = [axis](int n) {
      std::array<int, 3> size{25, 25, 25};
      size[axis] = n;
      return thin(size, [](int, int, int) { return true; });
    };
    EXPECT_TRUE(wall(16).empty()) << "above";
    EXPECT_TRUE(wall(15).empty()) << "at the rule";
    const std::vector<ThinPlace> below = wall(13);
    ASSERT_EQ(below.size(), 1);
    EXPECT_NEAR(below[0].width_mm, 1.3, 1e-9);
    EXPECT_EQ(below[0].region.high[axis], 13) << "as a whole";
    const std::vector<ThinPlace> sheet = wall(1);
    ASSERT_EQ(sheet.size(), 1);
    EXPECT_NEAR(sheet[0].width_mm, 0.1, 1e-9);
  }
}

TEST(ThinPlaces, AreWallsThatAreTurnedBy45Degrees) {
  const auto wall = [](double thick_mm) {
    return thin({60, 60, 20}, [thick_mm](int x, int y, int) {
      return std::abs(x - y) * 0.1 / std::sqrt(2) <= thick_mm / 2 && x + y > 24 && x + y < 94;
    });
  };
  EXPECT_TRUE(wall(1.7).empty());
  const std::vector<ThinPlace> below = wall(1.0);
  ASSERT_EQ(below.size(), 1);
  EXPECT_NEAR(below[0].width_mm, 1.0, 0.15);
}

TEST(ThinPlaces, ArePinsOnABlockAndNotTheBlock) {
  const auto pin = [](double diameter_mm) {
    return thin({40, 40, 45}, [diameter_mm](int x, int y, int z) {
      return z < 20 || std::hypot(x - 20, y - 20) * 0.1 < diameter_mm / 2;
    });
  };
  EXPECT_TRUE(pin(1.7).empty());
  const std::vector<ThinPlace> below = pin(0.9);
  ASSERT_EQ(below.size(), 1);
  EXPECT_NEAR(below[0].width_mm, 0.9, 0.15);
  EXPECT_EQ(below[0].region.high[2], 45);
  EXPECT_GE(below[0].region.low[2], 20 + 7) << "what is near the block, the block carries";
}

TEST(ThinPlaces, AreAWallThatAGapKeepsFromItsBlock) {
  // A wall of 0.5 mm, 0.4 mm beside the block: nearer than half the rule, and not held by it.
  const std::vector<ThinPlace> found =
      thin({34, 25, 25}, [](int x, int, int) { return x < 25 || x >= 29; });
  ASSERT_EQ(found.size(), 1);
  EXPECT_EQ(found[0].region.low[0], 29);
  EXPECT_NEAR(found[0].width_mm, 0.5, 1e-9);
}

TEST(ThinPlaces, OfThePowderAreDeepSlotsAndNotEngravings) {
  const auto slot = [](int wide, int deep) {
    return thin(
        {60, 30, 40}, [=](int x, int, int z) { return x < 20 || x >= 20 + wide || z < 40 - deep; },
        Matter::kPowder);
  };
  EXPECT_TRUE(slot(16, 30).empty()) << "wide";
  EXPECT_TRUE(slot(5, 6).empty()) << "an engraving";
  const std::vector<ThinPlace> narrow = slot(5, 30);
  ASSERT_EQ(narrow.size(), 1);
  EXPECT_NEAR(narrow[0].width_mm, 0.5, 1e-9);
  EXPECT_EQ(narrow[0].region.low[0], 20);
  EXPECT_EQ(narrow[0].region.high[0], 25);
  EXPECT_EQ(narrow[0].region.low[2], 10);
}

TEST(ThinPlaces, NeedThreeVoxels) {
  EXPECT_DOUBLE_EQ(least_rule_mm(kGrid), 0.3);
  EXPECT_DOUBLE_EQ(least_rule_mm({{0.08, 0.05, 0.2}, {2, 2, 2}}), 0.6) << "layers, not slices";
}

}  // namespace
}  // namespace binderjet
