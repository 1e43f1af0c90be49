// SPDX-License-Identifier: GPL-3.0-or-later
// Depth by hand, and against a search through all voxels.
#include "slicer/score/depth.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/random.h"
#include "tests/support/score_volumes.h"

namespace binderjet {
namespace {

using whole::Random;
using whole::Volume;

double gap(int voxels, double voxel_mm) { return std::max(0.0, std::abs(voxels) - 0.5) * voxel_mm; }

// Voxels from `margin` outside the volume on are all powder.
double nearest_other(const Volume& v, std::array<int, 3> from, const Grid& grid, int margin) {
  double best = Depths::kMaxMm;
  for (int z = -margin; z < v.nz + margin; ++z)
    for (int y = -margin; y < v.ny + margin; ++y)
      for (int x = -margin; x < v.nx + margin; ++x) {
        if (v.at(x, y, z) == v.at(from[0], from[1], from[2])) continue;
        best = std::min(
            best, std::hypot(gap(x - from[0], grid.voxel_mm(0)), gap(y - from[1], grid.voxel_mm(1)),
                             gap(z - from[2], grid.voxel_mm(2))));
      }
  return best;
}

TEST(Depths, AreThoseOfASearchThroughAllVoxels) {
  Random random;
  for (int round = 0; round < 60; ++round) {
    SCOPED_TRACE(round);
    const int rz = random.number(1, 3);
    const Grid grid{
        {random.number(1, 9) / 10.0, random.number(1, 9) / 10.0, rz * random.number(1, 9) / 10.0},
        {1, 1, rz}};
    const int layers = random.number(1, 4);
    Volume target = random.volume(random.number(1, 9), random.number(1, 9), layers * rz);
    // Solid blocks, so that there are depths of more than a voxel.
    if (round % 2 == 0) target.fill([](int, int, int) { return true; });
    const Volume printed = random.volume(target.nx, target.ny, layers);
    std::int64_t count = 0;
    std::optional<WrongPlace> worst;
    for (int z = 0; z < target.nz; ++z)
      for (int y = 0; y < target.ny; ++y)
        for (int x = 0; x < target.nx; ++x) {
          const int print = printed.at(x, y, z / rz);
          int wrong = 0;
          for (int s = 0; s < rz; ++s) wrong += target.at(x, y, z / rz * rz + s) != print ? 1 : 0;
          if (target.at(x, y, z) == print || 2 * wrong <= rz) continue;
          ++count;
          const WrongPlace place{nearest_other(target, {x, y, z}, grid, 1), {x, y, z}};
          if (!worst || place.depth_mm > worst->depth_mm + 1e-9) worst = place;
        }
    const Depths depths = whole::score(target, printed, grid, random.number(1, 3)).score.depths;
    ASSERT_EQ(depths.count(), count);
    ASSERT_EQ(depths.worst().has_value(), worst.has_value());
    if (!worst) continue;
    // The same sums of squares in another order.
    ASSERT_NEAR(depths.worst()->depth_mm, worst->depth_mm, 1e-9);
  }
}

// 0.1 mm voxels, one slice a layer.
const Grid kCubes{{0.1, 0.1, 0.1}, {1, 1, 1}};

Volume cube(int side, int low, int high) {
  Volume v(side, side, side);
  v.fill([&](int x, int y, int z) {
    return std::min({x, y, z}) >= low && std::max({x, y, z}) < high;
  });
  return v;
}

TEST(Depths, AreNoneWhereNothingIsWrong) {
  const Volume part = cube(9, 2, 7);
  const Depths depths = whole::score(part, part, kCubes).score.depths;
  EXPECT_EQ(depths.count(), 0);
  EXPECT_EQ(depths.p999_mm(), 0);
  EXPECT_FALSE(depths.worst());
  EXPECT_TRUE(depths.places(5).empty());
}

TEST(Depths, OfACubeThatIsNotPrintedAreDeepestInItsMiddle) {
  const Depths depths = whole::score(cube(9, 2, 7), Volume(9, 9, 9), kCubes).score.depths;
  EXPECT_EQ(depths.count(), 125);
  EXPECT_DOUBLE_EQ(depths.worst()->depth_mm, 0.25);  // two voxels and a half
  EXPECT_EQ(depths.worst()->voxel, (std::array<int, 3>{4, 4, 4}));
  EXPECT_EQ(depths.worst()->kind, WrongKind::kLost);
  EXPECT_DOUBLE_EQ(depths.p999_mm(), 0.25) << "124 of 125 are less than 99.9 %";
}

TEST(Depths, OfAPrintFarFromThePartIsMoreThanIsSearched) {
  // A voxel is wanted at one end of a bed of 4 mm, and one at the other is printed.
  Volume target(40, 3, 1);
  target.set(0, 1, 0, true);
  Volume printed = target;
  printed.set(39, 1, 0, true);
  const Depths far = whole::score(target, printed, kCubes).score.depths;
  EXPECT_EQ(far.count(), 1);
  EXPECT_EQ(far.worst()->depth_mm, Depths::kMaxMm);
  EXPECT_EQ(far.worst()->voxel[0], 39);
  // 20 voxels on, its nearest side is 19.5 voxels away: within what is searched.
  printed = target;
  printed.set(20, 1, 0, true);
  EXPECT_DOUBLE_EQ(whole::score(target, printed, kCubes).score.depths.worst()->depth_mm, 1.95);
  // In an empty target nothing is near.
  EXPECT_EQ(whole::score(Volume(40, 3, 1), printed, kCubes).score.depths.worst()->depth_mm,
            Depths::kMaxMm);
}

TEST(Depths, LeaveOutWhatTheLayerHeightCannotAvoid) {
  // Layers of two slices under a flat top in the middle of the second layer: one slice of it is
  // wrong whatever is printed. A layer more is too much, a layer less too little.
  const Grid grid{{0.1, 0.1, 0.2}, {1, 1, 2}};
  Volume target(5, 5, 8);
  target.fill([](int, int, int z) { return z < 3; });
  const auto print = [&](int layers) {
    Volume printed(5, 5, 4);
    printed.fill([&](int, int, int z) { return z < layers; });
    return whole::score(target, printed, grid).score.depths;
  };
  EXPECT_EQ(print(1).count(), 0);
  EXPECT_EQ(print(2).count(), 0);
  EXPECT_EQ(print(3).count(), 50);
  EXPECT_DOUBLE_EQ(print(3).worst()->depth_mm, 0.25) << "three slices up, less half a slice";
  EXPECT_EQ(print(3).worst()->voxel, (std::array<int, 3>{0, 0, 5}));
  EXPECT_EQ(print(0).count(), 50) << "the first layer only";
  EXPECT_DOUBLE_EQ(print(0).worst()->depth_mm, 0.15) << "from below; the top is as far";

  // Of three slices two are wrong: the other choice would have been better.
  const Grid three{{0.1, 0.1, 0.3}, {1, 1, 3}};
  Volume column(1, 1, 3);
  column.set(0, 0, 0, true);
  Volume solid(1, 1, 1);
  solid.set(0, 0, 0, true);
  EXPECT_EQ(whole::score(column, solid, three).score.depths.count(), 2);
  EXPECT_EQ(whole::score(column, Volume(1, 1, 1), three).score.depths.count(), 0);
}

TEST(Depths, OfAShareAreThoseOfTheWholeJob) {
  // A block of 10 layers loses one voxel in the middle of its fifth layer.
  Volume target = cube(30, 0, 30);
  target.nz = 10;
  target.bits.resize(target.place(0, 0, 10));
  Volume printed = target;
  printed.set(15, 15, 4, false);
  const double depth_mm = whole::score(target, printed, kCubes).score.depths.worst()->depth_mm;
  EXPECT_DOUBLE_EQ(depth_mm, 0.45) << "from the bed";
  const LayerRange share{4, 6};
  const LayerRange around = target_around(share, kCubes, 10);
  EXPECT_EQ(around, (LayerRange{0, 10}));
  EXPECT_EQ(target_around({40, 60}, kCubes, 1000), (LayerRange{20, 80})) << "2 mm";
  std::vector<Shared<RunLayer>> layers;
  const auto stream = score_layers(
      whole::voxel_stream(target, 1, around),
      std::make_unique<whole::VolumeStream<RunLayer>>(printed, 1, share), kCubes, share);
  Scorer scorer(kCubes, share.first);
  while (stream->rest().size() > 0) {
    for (const Shared<LayerScore>& layer : stream->next(1)) scorer.add(*layer);
  }
  const JobScore score = scorer.finish();
  EXPECT_EQ(score.voxels.solid, 2 * 900);
  EXPECT_DOUBLE_EQ(score.depths.worst()->depth_mm, depth_mm);
  EXPECT_EQ(score.depths.worst()->voxel, (std::array<int, 3>{15, 15, 4}));
}

TEST(Depths, NameEachPlaceThatHangsTogetherOnce) {
  // A plate of 11 x 4 x 1 mm loses two stripes and grows a tooth.
  Volume target(120, 60, 10);
  target.fill([](int x, int y, int) { return y < 40 && x < 110; });
  Volume printed = target;
  const auto change = [&](int x0, int x1, int y0, int y1, bool solid) {
    for (int z = 0; z < 10; ++z)
      for (int y = y0; y < y1; ++y)
        for (int x = x0; x < x1; ++x) printed.set(x, y, z, solid);
  };
  change(5, 100, 0, 3, false);      // 9.5 mm long, 0.3 mm deep
  change(45, 48, 30, 40, false);    // 1 mm deep, and half the plate's height from its faces
  change(110, 120, 20, 22, true);   // 1 mm long
  change(100, 110, 39, 40, false);  // one voxel deep: no place worth a name
  const Depths depths = whole::score(target, printed, kCubes).score.depths;
  const std::vector<WrongPlace> places = depths.places(9);
  ASSERT_EQ(places.size(), 3U);
  EXPECT_DOUBLE_EQ(places[0].depth_mm, 0.95);
  EXPECT_EQ(places[0].voxel, (std::array<int, 3>{119, 20, 0}));
  EXPECT_EQ(places[0].kind, WrongKind::kExtra);
  EXPECT_DOUBLE_EQ(places[1].depth_mm, 0.45);
  EXPECT_EQ(places[1].voxel, (std::array<int, 3>{45, 30, 4}));
  EXPECT_EQ(places[1].kind, WrongKind::kMissing) << "what is printed is within wear's reach";
  EXPECT_DOUBLE_EQ(places[2].depth_mm, 0.25);
  EXPECT_EQ(places[2].voxel, (std::array<int, 3>{5, 2, 2}));
  EXPECT_EQ(depths.places(2).size(), 2U);
}

}  // namespace
}  // namespace binderjet
