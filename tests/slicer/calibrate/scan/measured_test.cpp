// SPDX-License-Identifier: GPL-3.0-or-later
// A scan of known pose, pitch, blur and noise comes back onto the job's voxel grid.
#include "slicer/calibrate/scan/measured.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <functional>
#include <numbers>
#include <random>

#include "slicer/base/error.h"
#include "tests/support/program.h"

namespace binderjet {
namespace {

// Whether a point (mm) of layer k is solid; `grown` moves every face outwards.
using Part = std::function<bool(double x, double y, int k, double grown)>;

constexpr double kVoxelX = 25.4 / 600;
constexpr double kVoxelY = 25.4 / 900;

// A plate with slots, walls and a pin that no turn or shift maps onto itself. Straight edges lie
// between voxels, so that voxelization moves none.
bool plate(double x, double y, int k, double grown) {
  const auto box = [&](double x0, double y0, double x1, double y1, double grow) {
    const auto on = [](double at, double voxel) { return std::round(at / voxel) * voxel; };
    return x >= on(x0, kVoxelX) - grow && x < on(x1, kVoxelX) + grow &&
           y >= on(y0, kVoxelY) - grow && y < on(y1, kVoxelY) + grow;
  };
  bool in = box(1, 1, 11, 8, grown);
  if (k >= 2) {
    for (int i = 0; i < 5; ++i) {
      const double at = 1.7 + 1.1 * i;
      if (box(at, 2, at + 0.3 + 0.08 * i, 4.5, -grown)) in = false;
    }
    for (int i = 0; i < 4; ++i) {
      const double at = 5.2 + 0.6 * i;
      if (box(8, at - 3, 10, at - 2.8 + 0.03 * i, -grown)) in = false;
    }
    if (std::hypot(x - 4, y - 6.5) < 0.8 - grown) in = false;
  }
  return in && k < 9;
}

StackInfo frame_of(int layers) {
  StackInfo frame;
  frame.kind = StackKind::kPrinted;
  frame.size = {284, 320, layers};
  frame.pitch_mm = {kVoxelX, kVoxelY, 0.1};
  frame.origin_mm = {3, -2, 0};
  return frame;
}
constexpr int kScanLayers = 10;

// The frame's own corner is the part's (0, 0).
std::vector<RunLayer> predicted(const Part& part, const StackInfo& frame) {
  std::vector<RunLayer> layers;
  for (int k = 0; k < frame.size[2]; ++k) {
    RunLayer layer(frame.size[0]);
    for (int y = 0; y < frame.size[1]; ++y) {
      bool solid = false;
      for (int x = 0; x < frame.size[0]; ++x) {
        const bool in = part((x + 0.5) * frame.pitch_mm[0], (y + 0.5) * frame.pitch_mm[1], k, 0);
        if (in == solid) continue;
        layer.flip(x);
        solid = in;
      }
      if (solid) layer.flip(frame.size[0]);
      layer.end_row();
    }
    layers.push_back(layer);
  }
  return layers;
}

struct ScanOf {
  Pose pose;
  double scale = 1;
  double grown = 0;
  double blur_mm = 0.05;
  double noise = 0.05;  // of the contrast
  double pitch_mm = 0.05;
  double z_pitch_mm = 0.1;
  double z_origin_mm = 0;  // as much is seen above
};

// Writes what a scanner of that pose sees of the part, in grays 40 to 210.
void write_scan(const std::string& folder, const Part& part, const StackInfo& frame,
                const ScanOf& scan, unsigned seed) {
  StackInfo info;
  info.kind = StackKind::kMeasured;
  const double height_mm = frame.size[2] * frame.pitch_mm[2] - 2 * scan.z_origin_mm;
  info.size = {300, 250, static_cast<int>(std::lround(height_mm / scan.z_pitch_mm))};
  info.pitch_mm = {scan.pitch_mm, scan.pitch_mm, scan.z_pitch_mm};
  info.origin_mm = {2, -3, scan.z_origin_mm};
  info.files = "measured_%06d.png";
  StackWriter stack(folder, info);
  std::mt19937 random(seed);
  std::normal_distribution<double> noise(0, scan.noise);
  const double turn = scan.pose.turn_deg * std::numbers::pi / 180;
  for (int k = 0; k < info.size[2]; ++k) {
    GrayPlane plane;
    plane.width = info.size[0];
    plane.height = info.size[1];
    plane.pitch_mm = {scan.pitch_mm, scan.pitch_mm};
    plane.origin_mm = {info.origin_mm[0], info.origin_mm[1]};
    const double z = info.origin_mm[2] + (k + 0.5) * scan.z_pitch_mm - scan.pose.shift_mm[2];
    const int layer = static_cast<int>(std::floor(z / frame.pitch_mm[2]));
    for (int y = 0; y < plane.height; ++y) {
      for (int x = 0; x < plane.width; ++x) {
        int inside = 0;
        for (int sub = 0; sub < 9; ++sub) {
          // Back from the scan to the job: unshift, unturn, unscale.
          const double u = info.origin_mm[0] + (x + (sub % 3 + 0.5) / 3) * scan.pitch_mm -
                           scan.pose.center_mm[0] - scan.pose.shift_mm[0];
          const double v = info.origin_mm[1] + (y + (sub / 3 + 0.5) / 3) * scan.pitch_mm -
                           scan.pose.center_mm[1] - scan.pose.shift_mm[1];
          const double p = (std::cos(turn) * u + std::sin(turn) * v) / scan.scale;
          const double q = (-std::sin(turn) * u + std::cos(turn) * v) / scan.scale;
          inside += part(p + scan.pose.center_mm[0] - frame.origin_mm[0],
                         q + scan.pose.center_mm[1] - frame.origin_mm[1], layer, scan.grown)
                        ? 1
                        : 0;
        }
        plane.values.push_back(static_cast<float>(inside) / 9);
      }
    }
    if (scan.blur_mm > 0) plane = blurred(plane, scan.blur_mm);
    const int aside = (plane.width - info.size[0]) / 2;
    std::vector<std::byte> rgb;
    for (int y = 0; y < info.size[1]; ++y) {
      for (int x = 0; x < info.size[0]; ++x) {
        const double value = plane.at(x + aside, y + aside) + noise(random);
        const double gray = std::clamp(40 + 170 * value, 0.0, 255.0);
        rgb.insert(rgb.end(), 3, static_cast<std::byte>(std::lround(gray)));
      }
    }
    stack.write_rgb(k, rgb);
  }
  stack.finish();
}

Pose pose_in(const StackInfo& frame, std::array<double, 3> shift_mm, double turn_deg) {
  return {{frame.origin_mm[0] + frame.size[0] * frame.pitch_mm[0] / 2,
           frame.origin_mm[1] + frame.size[1] * frame.pitch_mm[1] / 2},
          shift_mm,
          turn_deg};
}

std::int64_t unequal(const RunLayer& a, const RunLayer& b) {
  std::int64_t count = 0;
  for (int y = 0; y < a.height(); ++y) {
    for (int x = 0; x < a.width(); ++x) count += a.at(x, y) != b.at(x, y) ? 1 : 0;
  }
  return count;
}

// The bounds of the task: shift to 0.01 mm, turn to 0.02 degrees.
void expect_pose(const Registration& found, const Pose& truth) {
  EXPECT_NEAR(found.pose.shift_mm[0], truth.shift_mm[0], 0.01);
  EXPECT_NEAR(found.pose.shift_mm[1], truth.shift_mm[1], 0.01);
  EXPECT_NEAR(found.pose.turn_deg, truth.turn_deg, 0.02);
  std::printf("off by %.4f, %.4f mm, %.4f degrees; scale %.4f, %.4f\n",
              found.pose.shift_mm[0] - truth.shift_mm[0],
              found.pose.shift_mm[1] - truth.shift_mm[1], found.pose.turn_deg - truth.turn_deg,
              found.scale[0], found.scale[1]);
}

TEST(Measured, FindsShiftAndTurnUnderBlurAndNoise) {
  const StackInfo frame = frame_of(kScanLayers);
  const auto wanted = predicted(plate, frame);
  std::random_device device;
  const unsigned seed = device();
  std::printf("seed %u\n", seed);
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> shift(-1, 1);
  for (const double turn : {0.4, 1.3, -6.0}) {
    const Workplace place;
    ScanOf scan;
    scan.pose = pose_in(frame, {shift(random), shift(random), 0}, turn);
    write_scan(place / "scan", plate, frame, scan, seed);
    const Measured measured = read_measured(place / "scan", frame, wanted);
    ASSERT_TRUE(measured.registration);
    expect_pose(*measured.registration, scan.pose);
    EXPECT_NEAR(measured.registration->scale[0], 1, 5e-4);
    EXPECT_NEAR(measured.grays.noise, 0.05, 0.01);
    EXPECT_EQ(measured.registration->pose.shift_mm[2], 0);
    // Within a quarter of a voxel of the edges on average: 0.01 mm of some 100 mm of edge.
    std::int64_t off = 0;
    std::int64_t solid = 0;
    for (std::size_t k = 0; k < wanted.size(); ++k) {
      off += unequal(measured.layers[k], wanted[k]);
      solid += wanted[k].count();
    }
    EXPECT_LT(static_cast<double>(off) / static_cast<double>(solid), 0.012);
  }
}

// What the printer does on both sides of every edge must not pull at the pose, and a printer that
// prints too large must still look so afterwards.
TEST(Measured, LeavesGrowthAndScaleInThePrint) {
  const StackInfo frame = frame_of(kScanLayers);
  const auto wanted = predicted(plate, frame);
  const Workplace place;
  ScanOf scan;
  scan.pose = pose_in(frame, {0.4, -0.3, 0}, 0.9);
  scan.grown = 0.08;
  write_scan(place / "grown", plate, frame, scan, 1);
  const Measured grown = read_measured(place / "grown", frame, wanted);
  expect_pose(*grown.registration, scan.pose);
  // 10.16 mm instead of 10 in a row without slots.
  const int row = static_cast<int>(7.6 / frame.pitch_mm[1]);
  const auto width_mm = [&](const Measured& measured) {
    const auto flips = measured.layers[5].row(row);
    return (flips.back() - flips.front()) * frame.pitch_mm[0];
  };
  EXPECT_NEAR(width_mm(grown), 10.16, frame.pitch_mm[0]);
  scan.grown = 0;
  scan.scale = 1.015;
  write_scan(place / "scaled", plate, frame, scan, 2);
  const Measured scaled = read_measured(place / "scaled", frame, wanted);
  expect_pose(*scaled.registration, scan.pose);
  EXPECT_NEAR(scaled.registration->scale[0], 1.015, 0.001);
  EXPECT_NEAR(scaled.registration->scale[1], 1.015, 0.001);
  EXPECT_NEAR(width_mm(scaled), 10.15, frame.pitch_mm[0]);
}

TEST(Measured, FindsTheHeightOfAScanWithSlicesOfItsOwn) {
  const StackInfo frame = frame_of(kScanLayers);
  const auto wanted = predicted(plate, frame);
  const Workplace place;
  ScanOf scan;
  scan.pose = pose_in(frame, {0.2, 0.1, 0.125}, -2);
  scan.z_origin_mm = -0.2;
  scan.z_pitch_mm = 0.025;  // faces lie between slices
  write_scan(place / "scan", plate, frame, scan, 3);
  const Measured measured = read_measured(place / "scan", frame, wanted);
  expect_pose(*measured.registration, scan.pose);
  EXPECT_NEAR(measured.registration->pose.shift_mm[2], 0.125, 0.01);
  EXPECT_TRUE(measured.layers[9].empty());
  EXPECT_NEAR(static_cast<double>(measured.layers[8].count()),
              static_cast<double>(wanted[8].count()),
              0.02 * static_cast<double>(wanted[8].count()));
}

TEST(Measured, StrewsNoVoxelsWhereAScanIsVeryNoisy) {
  const StackInfo frame = frame_of(kScanLayers);
  const auto wanted = predicted(plate, frame);
  const Workplace place;
  ScanOf scan;
  scan.pose = pose_in(frame, {0, 0.2, 0}, 0.5);
  scan.noise = 0.3;
  write_scan(place / "scan", plate, frame, scan, 4);
  const Measured measured = read_measured(place / "scan", frame, wanted);
  expect_pose(*measured.registration, scan.pose);
  // The empty top layer and a row of the plate's middle, without a slot in it.
  EXPECT_TRUE(measured.layers[9].empty());
  EXPECT_EQ(measured.layers[5].row(static_cast<int>(7.6 / frame.pitch_mm[1])).size(), 2U);
}

StackInfo like(const StackInfo& frame, std::array<int, 3> size, std::array<double, 3> pitch_mm) {
  StackInfo info = frame;
  info.kind = StackKind::kMeasured;
  info.size = size;
  info.pitch_mm = pitch_mm;
  info.files = "measured_%06d.png";
  return info;
}

TEST(Measured, TakesAStackOnTheVoxelGridBitForBit) {
  const StackInfo frame = frame_of(3);
  std::mt19937 random(5);
  const Workplace place;
  std::vector<RunLayer> truth;
  StackWriter stack(place / "scan", like(frame, frame.size, frame.pitch_mm));
  for (int k = 0; k < frame.size[2]; ++k) {
    RunLayer layer(frame.size[0]);
    for (int y = 0; y < frame.size[1]; ++y) {
      for (int x = static_cast<int>(random() % 9); x + 9 < frame.size[0];
           x += 1 + static_cast<int>(random() % 9)) {
        layer.flip(x);
        layer.flip(++x);
      }
      layer.end_row();
    }
    stack.write(k, layer);
    truth.push_back(layer);
  }
  stack.finish();
  const Measured measured = read_measured(place / "scan", frame, predicted(plate, frame));
  EXPECT_FALSE(measured.registration);
  EXPECT_EQ(measured.layers, truth);
  EXPECT_EQ(measured.grays.noise, 0);
}

// A stack at the printer's pixels, as the emulated printer gives it, a pixel to the right of the
// frame and a layer up.
TEST(Measured, RepeatsAStackOfWholePixels) {
  const StackInfo frame = frame_of(3);
  const Workplace place;
  StackInfo pixels = like(frame, {2, 1, 1}, {2 * frame.pitch_mm[0], 2 * frame.pitch_mm[1], 0.1});
  pixels.origin_mm[0] += 2 * frame.pitch_mm[0];
  pixels.origin_mm[2] += 0.1;
  StackWriter stack(place / "scan", pixels);
  RunLayer layer(2);
  layer.append_row(std::vector{1, 2});
  stack.write(0, layer);
  stack.finish();
  const Measured measured = read_measured(place / "scan", frame, predicted(plate, frame));
  EXPECT_TRUE(measured.layers[0].empty());
  EXPECT_EQ(measured.layers[1].count(), 4);
  EXPECT_THAT(std::vector<int>(measured.layers[1].row(1).begin(), measured.layers[1].row(1).end()),
              testing::ElementsAre(4, 6));
  EXPECT_TRUE(measured.layers[2].empty());
}

TEST(Measured, RefusesAnEmptyScan) {
  const StackInfo frame = frame_of(2);
  const Workplace place;
  StackWriter stack(place / "scan", like(frame, {10, 10, 2}, {0.05, 0.05, 0.1}));
  for (int k = 0; k < 2; ++k) stack.write(k, RunLayer::powder(10, 10));
  stack.finish();
  EXPECT_THROW(read_measured(place / "scan", frame, predicted(plate, frame)), Error);
}

}  // namespace
}  // namespace binderjet
