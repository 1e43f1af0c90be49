// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/score/trapped_powder.h"

#include <gtest/gtest.h>

#include "tests/support/vector_stream.h"

namespace binderjet {
namespace {

// A block of 12 x 12 x 8 layers; `hole(x, y, z)` is powder in it.
template <class Hole>
std::vector<Region> pockets(Hole hole) {
  TrappedPowder powder;
  std::vector<Region> found;
  for (int z = 0; z < 8; ++z) {
    RunLayer layer(12);
    for (int y = 0; y < 12; ++y) {
      for (int x = 0; x < 12; ++x) {
        if (!hole(x, y, z)) {
          layer.flip(x);
          layer.flip(x + 1);
        }
      }
      layer.end_row();
    }
    for (const Region& pocket : powder.add(layer)) found.push_back(pocket);
  }
  return found;
}

bool inside(int x, int y, int z) { return x >= 4 && x < 8 && y >= 3 && y < 9 && z >= 2 && z < 5; }

TEST(TrappedPowder, FindsAClosedPocket) {
  const std::vector<Region> found = pockets(inside);
  ASSERT_EQ(found.size(), 1);
  EXPECT_EQ(found[0].low, (std::array{4, 3, 2}));
  EXPECT_EQ(found[0].high, (std::array{8, 9, 5}));
  EXPECT_EQ(found[0].voxels, 4 * 6 * 3);
}

TEST(TrappedPowder, LeavesWhatHasAWayOutToAnySide) {
  for (int way = 0; way < 6; ++way) {
    SCOPED_TRACE(way);
    EXPECT_TRUE(pockets([way](int x, int y, int z) {
                  if (inside(x, y, z)) return true;
                  const bool along_x = y == 5 && z == 3;
                  const bool along_y = x == 5 && z == 3;
                  const bool along_z = x == 5 && y == 5;
                  switch (way) {
                    case 0:
                      return along_x && x < 4;
                    case 1:
                      return along_x && x >= 8;
                    case 2:
                      return along_y && y < 3;
                    case 3:
                      return along_y && y >= 9;
                    case 4:
                      return along_z && z < 2;
                    default:
                      return along_z && z >= 5;
                  }
                }).empty());
  }
}

TEST(TrappedPowder, TakesACornerForClosed) {
  // Powder does not go through an edge.
  EXPECT_EQ(pockets([](int x, int y, int z) {
              return inside(x, y, z) || (x < 4 && y < 3 && z == 3);
            }).size(),
            1);
}

}  // namespace
}  // namespace binderjet
