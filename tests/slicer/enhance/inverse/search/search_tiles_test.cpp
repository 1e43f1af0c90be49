// SPDX-License-Identifier: GPL-3.0-or-later
// Tiles are where something is to be decided, and all of it.
#include "slicer/enhance/inverse/search/search_tiles.h"

#include <gtest/gtest.h>

#include "slicer/enhance/inverse/search/change_count.h"
#include "tests/support/random.h"

namespace binderjet {
namespace {

using whole::Random;

TEST(SearchTiles, AreOnlyAroundTheEdgeOfALargePart) {
  const Grid grid{{1, 1, 1}, {2, 2, 1}};
  const int size = 20 * kTilePx;
  RunLayer slice(2 * size);
  for (int y = 0; y < 2 * size; ++y) {
    if (y >= 200 && y < 1500) {
      slice.flip(200);
      slice.flip(1500);
    }
    slice.end_row();
  }
  const RunLayer* slices[] = {&slice};
  const auto tiles = search_tiles(slices, grid, {10, 6});
  // Four sides of 1300 voxels, 13.5 tiles each, and no more than two tiles wide.
  EXPECT_GE(tiles.size(), 4U * 13);
  EXPECT_LE(tiles.size(), 2U * 4 * 15);
}

TEST(SearchTiles, LeaveOutOnlyPixelsThatReachNoChange) {
  Random random;
  for (int round = 0; round < 100; ++round) {
    SCOPED_TRACE(round);
    const Grid grid = random.grid();
    const std::array<int, 2> reach{random.number(0, 5), random.number(0, 5)};
    const int nx = random.number(1, 3 * kTilePx);
    const int ny = random.number(1, 3 * kTilePx);
    const whole::Volume target = random.volume(nx * grid.detail_vx[0], ny * grid.detail_vx[1], 2);
    const RunLayer below = whole::slice(target, 0);
    const RunLayer above = whole::slice(target, 1);
    const RunLayer* slices[] = {&below, &above};
    Plane<std::uint8_t> active(Rect{0, 0, nx, ny});
    for (const Rect& tile : search_tiles(slices, grid, reach)) {
      for (int y = tile.y0; y < tile.y1; ++y) {
        for (int x = tile.x0; x < tile.x1; ++x) ++*active.at(x, y);
      }
    }
    Plane<int> state(Rect{0, 0, target.nx, target.ny}.grown(5, 5));
    add_layer(below, 1, state);
    add_layer(above, 2, state);
    const ChangeCount changes(state);
    for (int y = 0; y < ny; ++y) {
      for (int x = 0; x < nx; ++x) {
        ASSERT_LE(*active.at(x, y), 1) << "tiles are disjoint";
        const Rect own{x * grid.detail_vx[0], y * grid.detail_vx[1], (x + 1) * grid.detail_vx[0],
                       (y + 1) * grid.detail_vx[1]};
        const Rect near = own.grown(reach[0], reach[1]);
        const bool mixed = *state.at(near.x0, near.y0) != 0 && *state.at(near.x0, near.y0) != 3;
        if (*active.at(x, y) == 0) {
          ASSERT_TRUE(changes.uniform(near) && !mixed) << x << ", " << y;
        }
      }
    }
  }
}

TEST(ChangeCount, KnowsRectanglesOfOneValue) {
  Random random;
  for (int round = 0; round < 300; ++round) {
    Plane<int> plane(Rect{-3, -2, random.number(1, 6), random.number(1, 6)});
    const Rect& rect = plane.rect();
    for (int y = rect.y0; y < rect.y1; ++y)
      for (int x = rect.x0; x < rect.x1; ++x) *plane.at(x, y) = random.chance(0.9) ? 7 : -7;
    const int x0 = random.number(rect.x0, rect.x1 - 1);
    const int y0 = random.number(rect.y0, rect.y1 - 1);
    const Rect some{x0, y0, random.number(x0 + 1, rect.x1), random.number(y0 + 1, rect.y1)};
    bool uniform = true;
    for (int y = some.y0; y < some.y1; ++y)
      for (int x = some.x0; x < some.x1; ++x) {
        uniform = uniform && *plane.at(x, y) == *plane.at(x0, y0);
      }
    ASSERT_EQ(ChangeCount(plane).uniform(some), uniform);
  }
}

}  // namespace
}  // namespace binderjet
