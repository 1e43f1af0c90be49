// SPDX-License-Identifier: GPL-3.0-or-later
// What happens to a part once it is bound, and masks that land in other layers: by hand, against
// plain loops over the whole volume, and streamed.
#include <gtest/gtest.h>

#include "slicer/base/error.h"
#include "slicer/calibrate/residual/dose_probe.h"
#include "slicer/model/printer_model.h"
#include "slicer/model/wear/morphology.h"
#include "tests/support/random.h"

namespace binderjet {
namespace {

using whole::Random;
using whole::Volume;

// Voxels of 0.1 mm; a pixel is one voxel.
const Grid kWearGrid{{0.1, 0.1, 0.1}, {1, 1, 1}};
const EffectSpec kHalfLevel{"threshold", {}, {{"level", {0.5}}}};

std::vector<RunLayer> layers_of(const Volume& v) {
  std::vector<RunLayer> out;
  for (int k = 0; k < v.nz; ++k) out.push_back(whole::slice(v, k));
  return out;
}
// Each layer from a window no larger than the model asks for.
Volume printed(const PrinterModel& model, const Volume& mask) {
  const std::vector<RunLayer> masks = layers_of(mask);
  std::vector<Shared<RunLayer>> out;
  for (int k = 0; k < mask.nz; ++k) {
    out.push_back(std::make_shared<const RunLayer>(
        model.print(runs_around(masks, k, model.window_reach()), k)));
  }
  return whole::stacked(out);
}
Volume block(int nx, int ny, int nz, int margin) {
  Volume v(nx, ny, nz);
  v.fill([&](int x, int y, int) {
    return x >= margin && y >= margin && x < nx - margin && y < ny - margin;
  });
  return v;
}

bool in_ball(int dx, int dy, int dz, double radius_vx) {
  return dx * dx + dy * dy + dz * dz <= radius_vx * radius_vx + 1e-9;
}
// Solid where `all` or any of the voxels within the ball is; beyond the stack in z is skipped if
// `skip`, else powder.
Volume by_ball(const Volume& v, int radius, bool all, bool skip) {
  Volume out(v.nx, v.ny, v.nz);
  out.fill([&](int x, int y, int z) {
    bool result = all;
    for (int c = -radius; c <= radius; ++c) {
      if (skip && (z + c < 0 || z + c >= v.nz)) continue;
      for (int b = -radius; b <= radius; ++b) {
        for (int a = -radius; a <= radius; ++a) {
          if (!in_ball(a, b, c, radius)) continue;
          const bool solid = v.at(x + a, y + b, z + c) == 1;
          result = all ? result && solid : result || solid;
        }
      }
    }
    return result;
  });
  return out;
}

TEST(Wear, BallRoundingIsTheOpeningOfTheWholePart) {
  Random random;
  for (int round = 0; round < 30; ++round) {
    SCOPED_TRACE(round);
    const int radius = random.number(1, 3);
    const Volume mask = random.volume(16, 14, 7, 2);
    const PrinterModel model(
        {kHalfLevel, {"rounding", {{"shape", "ball"}}, {{"radius_mm", {radius * 0.1}}}}},
        kWearGrid);
    ASSERT_EQ(printed(model, mask),
              by_ball(by_ball(mask, radius, true, false), radius, false, true));
  }
}

TEST(Wear, DiscRoundingOpensEachLayerAlone) {
  Random random;
  const Volume mask = random.volume(16, 14, 5, 2);
  const EffectSpec disc{"rounding", {{"shape", "disc"}}, {{"radius_mm", {0.2}}}};
  const EffectSpec ball{"rounding", {{"shape", "ball"}}, {{"radius_mm", {0.2}}}};
  // Layers far thicker than the radius: no ball reaches the next.
  Grid thick = kWearGrid;
  thick.pitch_mm[2] = 1;
  const PrinterModel model({kHalfLevel, disc}, kWearGrid);
  EXPECT_EQ(model.wear_reach(), 0);
  EXPECT_EQ(printed(model, mask), printed(PrinterModel({kHalfLevel, ball}, thick), mask));
}

TEST(Wear, InfiltrantIsTheClosingOfTheWholePartAndASkin) {
  Random random;
  for (int round = 0; round < 30; ++round) {
    SCOPED_TRACE(round);
    const int radius = random.number(1, 3);
    const int skin = random.number(0, radius);
    const Volume mask = random.volume(18, 16, 7, 5);
    const PrinterModel model(
        {kHalfLevel,
         {"infiltrant", {}, {{"radius_mm", {radius * 0.1}}, {"skin_mm", {skin * 0.1}}}}},
        kWearGrid);
    ASSERT_EQ(printed(model, mask),
              by_ball(by_ball(mask, radius, false, true), radius - skin, true, true));
  }
}

TEST(Wear, GaussianRoundingLeavesFlatFacesAndTakesCorners) {
  const Volume mask = block(40, 40, 9, 8);
  const PrinterModel model(
      {kHalfLevel, {"rounding", {{"shape", "gaussian"}}, {{"radius_mm", {0.15}}}}}, kWearGrid);
  const Volume out = printed(model, mask);
  EXPECT_EQ(out.at(8, 20, 4), 1);
  EXPECT_EQ(out.at(7, 20, 4), 0);
  EXPECT_EQ(out.at(20, 20, 0), 1) << "the bottom is flat";
  EXPECT_EQ(out.at(8, 8, 4), 0) << "a corner is not";
  EXPECT_EQ(out.at(8, 20, 0), 0) << "nor an edge below";
}

TEST(Wear, FillsASlotAndKeepsAWideOne) {
  Volume mask = block(40, 20, 5, 5);
  for (int z = 0; z < 5; ++z) {
    for (int y = 5; y < 15; ++y) {
      for (const int x : {12, 13, 22, 23, 24, 25, 26}) mask.set(x, y, z, false);
    }
  }
  const PrinterModel model(
      {kHalfLevel, {"infiltrant", {}, {{"radius_mm", {0.15}}, {"skin_mm", {0}}}}}, kWearGrid);
  const Volume out = printed(model, mask);
  EXPECT_EQ(out.at(12, 10, 2), 1);
  EXPECT_EQ(out.at(24, 10, 2), 0);
}

TEST(Wear, ComesAfterWhatWasBoundFromLayersAround) {
  const Volume mask = block(30, 30, 8, 8);
  const PrinterModel model({{"spread", {{"shape", "box"}}, {{"width_mm", {0.5, 0.3}}}},
                            kHalfLevel,
                            {"z_bleed_down", {}, {{"share", {0.4}}}},
                            {"rounding", {{"shape", "ball"}}, {{"radius_mm", {0.2}}}}},
                           kWearGrid);
  EXPECT_EQ(model.wear_reach(), 4);
  EXPECT_EQ(model.window_reach(), model.bind_reach() + model.wear_reach());
  const PrinterModel unworn({{"spread", {{"shape", "box"}}, {{"width_mm", {0.5, 0.3}}}},
                             kHalfLevel,
                             {"z_bleed_down", {}, {{"share", {0.4}}}}},
                            kWearGrid);
  EXPECT_EQ(printed(model, mask),
            by_ball(by_ball(printed(unworn, mask), 2, true, false), 2, false, true));
}

TEST(LayerMoves, LoseALayerFromAHeightOn) {
  Random random;
  const Volume mask = random.volume(12, 10, 9, 1);
  for (const int lost : {-2, -1, 1, 2}) {
    const PrinterModel model(
        {kHalfLevel,
         {"slice_dropout", {}, {{"at_mm", {0.4}}, {"layers", {static_cast<double>(lost)}}}}},
        kWearGrid);
    Volume expected(mask.nx, mask.ny, mask.nz);
    expected.fill([&](int x, int y, int z) { return mask.at(x, y, z < 4 ? z : z + lost) == 1; });
    EXPECT_EQ(printed(model, mask), expected);
  }
}

TEST(LayerMoves, TakeTheBinderThatBleedsAlong) {
  Random random;
  const Volume mask = random.volume(12, 10, 9, 1);
  const EffectSpec bleed{"z_bleed_down", {}, {{"share", {0.6}}}};
  const EffectSpec lost{"slice_dropout", {}, {{"at_mm", {0.4}}, {"layers", {1}}}};
  Volume moved(mask.nx, mask.ny, mask.nz);
  moved.fill([&](int x, int y, int z) { return mask.at(x, y, z < 4 ? z : z + 1) == 1; });
  EXPECT_EQ(printed(PrinterModel({kHalfLevel, bleed, lost}, kWearGrid), mask),
            printed(PrinterModel({kHalfLevel, bleed}, kWearGrid), moved));
}

TEST(LayerMoves, CompressTheHeight) {
  // A tenth: the middle of printed layer 9 is where 9.5 / 0.9 = 10.6 was meant to be.
  Volume mask(4, 4, 20);
  mask.fill([](int, int, int z) { return z == 0 || z == 10 || z == 19; });
  const PrinterModel model({kHalfLevel, {"recoat_compress", {}, {{"share", {0.1}}}}}, kWearGrid);
  const Volume out = printed(model, mask);
  std::vector<int> solid;
  for (int z = 0; z < 20; ++z) {
    if (out.at(1, 1, z) == 1) solid.push_back(z);
  }
  EXPECT_EQ(solid, (std::vector<int>{0, 9, 17}));
}

TEST(FirstDrops, DrawBackTheEdgeWhereALineStarts) {
  RunLayer mask(60);
  for (int y = 0; y < 5; ++y) mask.append_row(std::vector<int>{10, 25, 35, 50});
  const auto row = [&](const std::string& after) {
    const PrinterModel model(
        {{"spread", {{"shape", "box"}}, {{"width_mm", {0.5, 0.3}}}},
         kHalfLevel,
         {"first_drops", {{"after", after}}, {{"amount", {0.9}}, {"length_mm", {0.3}}}}},
        kWearGrid);
    const RunLayer out = model.print(mask);
    return std::vector<int>{out.row(2).begin(), out.row(2).end()};
  };
  // Drops 0, 1, 2, 3 lack 0.76, 0.55, 0.39, 0.28: the box of 5 holds half of its dose from 12 on.
  EXPECT_EQ(row("line"), (std::vector<int>{12, 25, 35, 50}));
  EXPECT_EQ(row("gap"), (std::vector<int>{12, 25, 37, 50}));
}

TEST(Streak, BeginsAtAHeight) {
  RunLayer mask(60);
  for (int y = 0; y < 5; ++y) mask.append_row(std::vector<int>{10, 50});
  const PrinterModel model(
      {kHalfLevel,
       {"recoat_streak",
        {{"across", "x"}},
        {{"from_mm", {2}}, {"to_mm", {2.3}}, {"at_mm", {0.7}}, {"amount", {-0.8}}}}},
      kWearGrid, {{0, 0}, {6, 0.5}});
  const RunWindow window{&mask};
  const auto row = [](const RunLayer& out) {
    return std::vector<int>{out.row(2).begin(), out.row(2).end()};
  };
  EXPECT_EQ(row(model.print(window, 6)), (std::vector<int>{10, 50}));
  EXPECT_EQ(row(model.print(window, 7)), (std::vector<int>{10, 20, 23, 50}));
}

TEST(Jitter, DoesNotChangeThePrintToExpect) {
  Random random;
  const Volume mask = random.volume(12, 10, 5, 1);
  const EffectSpec jitter{"jitter", {}, {{"sigma_mm", {0.1, 0.1}}}};
  EXPECT_EQ(printed(PrinterModel({kHalfLevel, jitter}, kWearGrid), mask), mask);
}

}  // namespace
}  // namespace binderjet
