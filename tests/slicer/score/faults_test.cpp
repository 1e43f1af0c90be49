// SPDX-License-Identifier: GPL-3.0-or-later
// The faults of volumes that a person can draw on paper.
#include "slicer/score/faults.h"

#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "tests/support/random.h"
#include "tests/support/score_volumes.h"

namespace binderjet {
namespace {

using whole::Random;
using whole::score;
using whole::Volume;

// Voxels of 0.1 mm, two slices a layer: 2 voxels are worn at most, and one layer.
const Grid kTwoSlices{{0.1, 0.1, 0.2}, {1, 1, 2}};

// Both from the same function of x, y and the layer.
template <class Solid>
Volume target_of(int nx, int ny, int layers, Solid solid) {
  Volume v(nx, ny, 2 * layers);
  v.fill([&](int x, int y, int z) { return solid(x, y, z / 2); });
  return v;
}
template <class Solid>
Volume printed_of(int nx, int ny, int layers, Solid solid) {
  Volume v(nx, ny, layers);
  v.fill(solid);
  return v;
}

void expect_counts(const JobScore& score, int lost, int fused, int spurious) {
  EXPECT_EQ(score.faults[FaultKind::kLost], lost);
  EXPECT_EQ(score.faults[FaultKind::kFused], fused);
  EXPECT_EQ(score.faults[FaultKind::kSpurious], spurious);
}

TEST(Faults, CountAPinThatVanishesAsOneLost) {
  const auto base = [](int x, int y, int k) {
    return k < 2 && x >= 2 && x < 20 && y >= 2 && y < 20;
  };
  const auto pin = [](int x, int y, int k) {
    return k >= 2 && x >= 8 && x < 12 && y >= 9 && y < 12;
  };
  const Volume target =
      target_of(22, 22, 7, [&](int x, int y, int k) { return base(x, y, k) || pin(x, y, k); });
  const auto result = score(target, printed_of(22, 22, 7, base), kTwoSlices);
  expect_counts(result.score, 1, 0, 0);
  // The layer that stands on the base is worn, the other four are lost.
  const Region region = result.faults.front().region;
  EXPECT_EQ(region.low, (std::array<int, 3>{8, 9, 6}));
  EXPECT_EQ(region.high, (std::array<int, 3>{12, 12, 14}));
  EXPECT_EQ(region.voxels, 4 * 3 * 8);
}

TEST(Faults, CountASlotThatClosesAsOneFused) {
  const auto block = [](int x, int y, int) { return x >= 3 && x < 27 && y >= 3 && y < 27; };
  const auto slot = [](int x, int, int) { return x >= 13 && x < 17; };
  const Volume target =
      target_of(30, 30, 5, [&](int x, int y, int k) { return block(x, y, k) && !slot(x, y, k); });
  const auto result = score(target, printed_of(30, 30, 5, block), kTwoSlices);
  expect_counts(result.score, 0, 1, 0);
  // It is open at both ends, below and above: two voxels and a layer there are only worn.
  const Region region = result.faults.front().region;
  EXPECT_EQ(region.low, (std::array<int, 3>{13, 5, 2}));
  EXPECT_EQ(region.high, (std::array<int, 3>{17, 25, 8}));
}

TEST(Faults, CountALonePrintedCrumbAsOneSpurious) {
  const auto block = [](int x, int, int) { return x >= 3 && x < 9; };
  const Volume target = target_of(20, 6, 3, block);
  const auto result = score(target,
                            printed_of(20, 6, 3,
                                       [&](int x, int y, int k) {
                                         return block(x, y, k) || (k > 0 && x == 15 && y == 3);
                                       }),
                            kTwoSlices);
  expect_counts(result.score, 0, 0, 1);
  EXPECT_EQ(result.faults.front().region.voxels, 2 * 2) << "two layers of two slices";
}

TEST(Faults, CountAsSpuriousOnlyWhatHoldsNoTargetInAnySlice) {
  // The target fills only the upper slice of its first layer.
  Volume target(20, 6, 4);
  target.fill([](int x, int, int z) { return x >= 3 && x < 9 && z == 1; });
  expect_counts(
      score(target,
            printed_of(20, 6, 2, [](int x, int, int k) { return k == 0 && x >= 3 && x < 9; }),
            kTwoSlices)
          .score,
      0, 0, 0);
}

TEST(Faults, CountAThinnedWallAndAThickenedOneAsNone) {
  const auto wall = [](int from, int to) {
    return [=](int x, int, int) { return x >= from && x < to; };
  };
  const Volume target = target_of(30, 30, 4, wall(10, 18));
  expect_counts(score(target, printed_of(30, 30, 4, wall(12, 16)), kTwoSlices).score, 0, 0, 0);
  expect_counts(score(target, printed_of(30, 30, 4, wall(8, 20)), kTwoSlices).score, 0, 0, 0);
}

TEST(Faults, CountAWallThatIsGoneAsOneLostBesideOneThatIsThere) {
  const auto wall = [](int x, int, int) { return x >= 3 && x < 7; };
  const Volume target = target_of(30, 12, 4, [&](int x, int y, int k) {
    return wall(x, y, k) || (x >= 9 && x < 11);  // two voxels away: near, but another wall
  });
  expect_counts(score(target, printed_of(30, 12, 4, wall), kTwoSlices).score, 1, 0, 0);
}

TEST(Faults, CountABrokenSpikeOnlyIfMoreThanWearIsGone) {
  const auto spike = [](int length) {
    return [=](int x, int y, int) {
      return (x >= 2 && x < 10) || (y >= 8 && y < 10 && x >= 10 && x < 10 + length);
    };
  };
  const Volume target = target_of(24, 18, 3, spike(10));
  expect_counts(score(target, printed_of(24, 18, 3, spike(8)), kTwoSlices).score, 0, 0, 0);
  expect_counts(score(target, printed_of(24, 18, 3, spike(7)), kTwoSlices).score, 1, 0, 0);
}

TEST(Faults, CountASkinThatALayerTooFewLeavesAsNone) {
  const auto block = [](int x, int y, int k) {
    return k < 4 && x >= 2 && x < 18 && y >= 2 && y < 18;
  };
  const auto lower = [&](int x, int y, int k) { return k < 3 && block(x, y, k); };
  const Volume target = target_of(20, 20, 5, block);
  expect_counts(score(target, printed_of(20, 20, 5, lower), kTwoSlices).score, 0, 0, 0);
}

TEST(Faults, CountWhatIsDiagonallyApartTwice) {
  const Volume target = target_of(20, 20, 3, [](int x, int y, int k) {
    return (k < 2 && x < 5 && y < 5) || (k < 2 && x >= 5 && y >= 5 && x < 9 && y < 9);
  });
  expect_counts(score(target, Volume(20, 20, 3), kTwoSlices).score, 2, 0, 0);
}

// The rows of the picture in faults.h, as blocks of 11 rows and 5 layers.
const std::string kTwoParts = ".####...##########..";

Volume block_of(const std::string& row, int slices) {
  Volume v(static_cast<int>(row.size()), 11, slices);
  v.fill([&](int x, int, int) { return row[static_cast<std::size_t>(x)] == '#'; });
  return v;
}

std::vector<Fault> found(const std::string& target, const std::string& printed, FaultScope scope) {
  const Volume wanted = block_of(target, 10);
  const Volume print = block_of(printed, 5);
  const auto layers = score_layers(whole::voxel_stream(wanted, 2, {0, 5}),
                                   whole::layer_stream(print), kTwoSlices, {0, 5})
                          ->next(5);
  FaultFinder finder(2, std::move(scope));
  std::vector<Fault> all;
  const auto take = [&](const std::vector<Fault>& faults) {
    all.insert(all.end(), faults.begin(), faults.end());
  };
  for (const auto& layer : layers) {
    take(finder.add(*layer->layer.target, *layer->layer.printed, layer->missing));
  }
  take(finder.finish());
  return all;
}

std::vector<std::string> words(const std::vector<Fault>& faults) {
  std::vector<std::string> out;
  for (const Fault& fault : faults) out.emplace_back(word(fault.kind));
  return out;
}

using Words = std::vector<std::string>;

TEST(Faults, AreOfTheFiveKindsThatTheHeaderDraws) {
  EXPECT_EQ(words(found(kTwoParts, kTwoParts, {})), Words{});
  EXPECT_EQ(words(found(kTwoParts, ".####...............", {})), Words{"lost"});
  EXPECT_EQ(words(found(kTwoParts, ".#################..", {})), (Words{"fused", "joined"}));
  EXPECT_EQ(words(found(kTwoParts, ".####...##########.#", {})), Words{"spurious"});
  EXPECT_EQ(words(found(kTwoParts, ".####...#####..###..", {})), Words{"loose"});
}

TEST(Faults, AreFoundOfTheKindsThatAreAskedForOnly) {
  const std::string all_at_once = ".#########..##.....#";  // the second part's end is lost, too
  // The fused gap ends a layer below the others, for the powder above it wears it.
  EXPECT_EQ(words(found(kTwoParts, all_at_once, {})),
            (Words{"fused", "lost", "spurious", "loose", "joined"}));
  for (const FaultKind kind : kFaultKinds) {
    EXPECT_EQ(words(found(kTwoParts, all_at_once, {.kinds = {kind}})),
              Words{std::string(word(kind))});
  }
}

TEST(Faults, CountSlicesFromTheJobsFirstWhereAPieceOfAJobBeginsHigher) {
  const std::string all_at_once = ".#########..##.....#";
  const std::vector<Fault> low = found(kTwoParts, all_at_once, {});
  const std::vector<Fault> high = found(kTwoParts, all_at_once, {.first_layer = 7});
  ASSERT_EQ(low.size(), 5);
  ASSERT_EQ(high.size(), 5);
  for (std::size_t i = 0; i < low.size(); ++i) {
    EXPECT_EQ(high[i].region.low[2], low[i].region.low[2] + 14) << word(low[i].kind);
    EXPECT_EQ(high[i].region.high[2], low[i].region.high[2] + 14) << word(low[i].kind);
  }
}

TEST(Faults, AreNeitherSpuriousNorLooseWhereTheyMayGoOn) {
  const auto at_the_end = [](const Region& region) { return region.high[0] == 20; };
  EXPECT_EQ(words(found(kTwoParts, ".####...##########.#", {.goes_on = at_the_end})), Words{});
  // The last piece of this part is the lesser one, and stays: the others come off it.
  const std::string part = "..##################";
  const std::string printed = "..#####..######..###";
  EXPECT_EQ(found(part, printed, {}).size(), 2);
  const std::vector<Fault> loose = found(part, printed, {.goes_on = at_the_end});
  EXPECT_EQ(words(loose), (Words{"loose", "loose"}));
  for (const Fault& fault : loose) EXPECT_LT(fault.region.high[0], 20);
}

// The definition voxel by voxel on a whole volume: what is neither printed nor worn.
Volume lost_voxels(const Volume& target, const Volume& printed, const Grid& grid) {
  const int rz = grid.detail_vx[2];
  const auto is_printed = [&](int x, int y, int z) {
    return z >= 0 && target.at(x, y, z) == 1 && printed.at(x, y, z / rz) == 1;
  };
  Volume kept = target;
  kept.fill([&](int x, int y, int z) {
    if (target.at(x, y, z) == 0) return false;
    bool found = is_printed(x, y, z);
    for (const int way : {-1, 1}) {
      int other = z;  // along the target into the layer below or above
      while (other >= 0 && other / rz == z / rz && target.at(x, y, other) == 1) other += way;
      if (other / rz != z / rz || other < 0) found = found || is_printed(x, y, other);
    }
    return found;
  });
  const auto spread = [&](int dx, int dy) {
    const Volume before = kept;
    kept.fill([&](int x, int y, int z) {
      return target.at(x, y, z) == 1 &&
             (before.at(x, y, z) == 1 ||
              before.at(x - dx, y - dy, z) + before.at(x + dx, y + dy, z) > 0);
    });
  };
  // Voxels of 0.1 mm: two steps, each along x and then along y.
  for (int step = 0; step < 2; ++step) {
    spread(1, 0);
    spread(0, 1);
  }
  Volume lost = target;
  lost.fill([&](int x, int y, int z) { return target.at(x, y, z) == 1 && kept.at(x, y, z) == 0; });
  return lost;
}

TEST(Faults, LoseTheVoxelsThatTheDefinitionSays) {
  Random random;
  std::int64_t found = 0;
  for (int round = 0; round < 200; ++round) {
    SCOPED_TRACE(round);
    const Grid grid{{0.1, 0.1, 0.1}, {1, 1, random.number(1, 3)}};
    const int rz = grid.detail_vx[2];
    const int layers = random.number(1, 5);
    const Volume target = random.volume(random.number(1, 24), random.number(1, 24), layers * rz);
    const Volume printed = random.volume(target.nx, target.ny, layers);
    const auto stream = score_layers(whole::voxel_stream(target, rz, {0, layers}),
                                     whole::layer_stream(printed), grid, {0, layers});
    std::vector<Shared<RunLayer>> slices;
    for (const auto& layer : stream->next(layers)) {
      for (const RunLayer& slice : layer->missing.lost) {
        slices.push_back(std::make_shared<const RunLayer>(slice));
        found += slice.count();
      }
    }
    ASSERT_EQ(whole::stacked(slices), lost_voxels(target, printed, grid));
  }
  EXPECT_GT(found, 0);
}

// Fused in powder is lost in solid: inside a thick block, the complements change places.
TEST(Faults, AreTheSameForPowderAsForSolid) {
  Random random;
  int found = 0;
  for (int round = 0; round < 100; ++round) {
    SCOPED_TRACE(round);
    const int layers = random.number(1, 5);
    const Volume a = random.volume(16, 16, 2 * layers);
    const Volume b = random.volume(16, 16, layers);
    Volume target(22, 22, 2 * (layers + 4));
    Volume printed(22, 22, layers + 4);
    target.fill([&](int x, int y, int z) { return a.at(x - 3, y - 3, z - 4) == 1; });
    printed.fill([&](int x, int y, int z) { return b.at(x - 3, y - 3, z - 2) == 1; });
    Volume not_target = target;
    not_target.fill([&](int x, int y, int z) { return target.at(x, y, z) == 0; });
    Volume not_printed = printed;
    not_printed.fill([&](int x, int y, int z) { return printed.at(x, y, z) == 0; });
    const auto solid = score(target, printed, kTwoSlices, 2);
    const auto powder = score(not_target, not_printed, kTwoSlices);
    ASSERT_EQ(solid.score.faults[FaultKind::kLost], powder.score.faults[FaultKind::kFused]);
    const auto lost = solid.regions(FaultKind::kLost);
    const auto fused = powder.regions(FaultKind::kFused);
    ASSERT_EQ(lost.size(), fused.size());
    for (std::size_t i = 0; i < lost.size(); ++i) {
      ASSERT_EQ(lost[i].low, fused[i].low);
      ASSERT_EQ(lost[i].high, fused[i].high);
      ASSERT_EQ(lost[i].voxels, fused[i].voxels);
    }
    found += static_cast<int>(lost.size());
  }
  EXPECT_GT(found, 0);
}

}  // namespace
}  // namespace binderjet
