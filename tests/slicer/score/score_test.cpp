// SPDX-License-Identifier: GPL-3.0-or-later
// The streamed score against plain searches over whole volumes.
#include "slicer/score/score.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "tests/support/random.h"
#include "tests/support/score_volumes.h"

namespace binderjet {
namespace {

using whole::Random;
using whole::Volume;

// The sides between differing voxels of one slice: middle and half length, in mm.
struct Side {
  double x;
  double y;
  double half_x;
  double half_y;
};
std::vector<Side> sides(const Volume& v, int z, double hx, double hy) {
  std::vector<Side> out;
  for (int y = 0; y <= v.ny; ++y) {
    for (int x = 0; x <= v.nx; ++x) {
      if (v.at(x - 1, y, z) != v.at(x, y, z)) out.push_back({x * hx, (y + 0.5) * hy, 0, hy / 2});
      if (v.at(x, y - 1, z) != v.at(x, y, z)) out.push_back({(x + 0.5) * hx, y * hy, hx / 2, 0});
    }
  }
  return out;
}

double distance(const Side& from, const Side& to) {
  return std::hypot(std::max(0.0, std::abs(from.x - to.x) - to.half_x),
                    std::max(0.0, std::abs(from.y - to.y) - to.half_y));
}

TEST(EdgeErrors, AreThoseOfASearchThroughAllEdges) {
  Random random;
  for (int round = 0; round < 100; ++round) {
    SCOPED_TRACE(round);
    const int rz = random.number(1, 3);
    const Grid grid{{random.number(1, 9) / 20.0, random.number(1, 9) / 20.0, 0.1}, {1, 1, rz}};
    const int layers = random.number(1, 3);
    const Volume target = random.volume(random.number(1, 30), random.number(1, 30), layers * rz);
    const Volume printed = random.volume(target.nx, target.ny, layers);
    double sum = 0;
    double most = 0;
    std::int64_t count = 0;
    for (int z = 0; z < target.nz; ++z) {
      const auto there = sides(printed, z / rz, grid.voxel_mm(0), grid.voxel_mm(1));
      for (const Side& edge : sides(target, z, grid.voxel_mm(0), grid.voxel_mm(1))) {
        double nearest = EdgeErrors::kMaxMm;
        for (const Side& other : there) nearest = std::min(nearest, distance(edge, other));
        sum += nearest;
        most = std::max(most, nearest);
        ++count;
      }
    }
    const EdgeErrors errors = whole::score(target, printed, grid).score.edges;
    ASSERT_EQ(errors.edges(), count);
    // Distances are rounded to whole nanometres.
    ASSERT_NEAR(errors.mean_mm(), count == 0 ? 0 : sum / static_cast<double>(count), 1e-6);
    ASSERT_NEAR(errors.max_mm(), most, 1e-6);
  }
}

TEST(EdgeErrors, OfAWallThatGrewAreItsGrowth) {
  // 0.1 mm voxels; a bar from 10 to 20 is printed from 9 to 22, and as long as the layer.
  const Grid grid{{0.1, 0.1, 0.1}, {1, 1, 1}};
  Volume target(40, 200, 1);
  target.fill([](int x, int, int) { return x >= 10 && x < 20; });
  Volume printed(40, 200, 1);
  printed.fill([](int x, int, int) { return x >= 9 && x < 22; });
  const EdgeErrors errors = whole::score(target, printed, grid).score.edges;
  // 200 sides are 0.1 mm off, 200 are 0.2 mm off, and 2 x 10 ends are right. By the corners the
  // bar's own end is nearer: 0.05 mm for the last side, 0.15 mm for the one before.
  EXPECT_EQ(errors.edges(), 420);
  EXPECT_NEAR(errors.mean_mm(), (198 * 0.1 + 196 * 0.2 + 4 * 0.05 + 2 * 0.15) / 420, 1e-6);
  EXPECT_DOUBLE_EQ(errors.p95_mm(), 0.2);
  EXPECT_DOUBLE_EQ(errors.max_mm(), 0.2);
}

TEST(EdgeErrors, OfWhatIsNotPrintedAreTheMostThatIsSearched) {
  const Grid grid{{0.1, 0.1, 0.1}, {1, 1, 1}};
  Volume target(5, 5, 1);
  target.set(2, 2, 0, true);
  const EdgeErrors errors = whole::score(target, Volume(5, 5, 1), grid).score.edges;
  EXPECT_EQ(errors.edges(), 4);
  EXPECT_DOUBLE_EQ(errors.mean_mm(), EdgeErrors::kMaxMm);
}

// Regions by flooding a whole volume, each as the set of its voxels.
std::multiset<std::pair<std::int64_t, bool>> flooded(Volume v, const Volume& marks) {
  std::multiset<std::pair<std::int64_t, bool>> out;
  for (int z = 0; z < v.nz; ++z)
    for (int y = 0; y < v.ny; ++y)
      for (int x = 0; x < v.nx; ++x) {
        if (v.at(x, y, z) == 0) continue;
        std::int64_t voxels = 0;
        bool touches = false;
        std::vector<std::array<int, 3>> open{{x, y, z}};
        v.set(x, y, z, false);
        while (!open.empty()) {
          const auto [a, b, c] = open.back();
          open.pop_back();
          ++voxels;
          touches = touches || marks.at(a, b, c) == 1;
          for (const auto& d : whole::kFaces) {
            if (v.at(a + d[0], b + d[1], c + d[2]) == 0) continue;
            v.set(a + d[0], b + d[1], c + d[2], false);
            open.push_back({a + d[0], b + d[1], c + d[2]});
          }
        }
        out.emplace(voxels, touches);
      }
  return out;
}

TEST(RegionFinder, FindsTheRegionsThatAFloodFinds) {
  Random random;
  for (int round = 0; round < 200; ++round) {
    SCOPED_TRACE(round);
    const Volume v = random.volume(random.number(1, 12), random.number(1, 12), random.number(1, 9));
    const Volume marks = random.volume(v.nx, v.ny, v.nz);
    RegionFinder finder;
    std::multiset<std::pair<std::int64_t, bool>> found;
    const auto take = [&](const std::vector<Region>& regions) {
      for (const Region& region : regions) found.emplace(region.voxels, region.touches);
    };
    for (int z = 0; z < v.nz; ++z) {
      const RunLayer slice_marks = whole::slice(marks, z);
      take(finder.add(whole::slice(v, z), &slice_marks));
    }
    take(finder.finish());
    ASSERT_EQ(found, flooded(v, marks));
  }
}

TEST(RegionFinder, TellsOfARegionAsSoonAsItEnds) {
  Volume v(8, 8, 6);
  v.fill([](int x, int y, int z) { return (x == 1 && y == 1 && z < 2) || (x == 5 && z < 4); });
  RegionFinder finder;
  std::vector<std::size_t> ended;
  for (int z = 0; z < v.nz; ++z) ended.push_back(finder.add(whole::slice(v, z)).size());
  EXPECT_EQ(ended, (std::vector<std::size_t>{0, 0, 1, 0, 1, 0}));
  EXPECT_TRUE(finder.finish().empty());
}

}  // namespace
}  // namespace binderjet
