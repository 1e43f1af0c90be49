// SPDX-License-Identifier: GPL-3.0-or-later
// Coupons hold the gauges that they promise, where slices are cut through them.
#include "slicer/coupon/coupon.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "slicer/coupon/coupon_shapes.h"
#include "slicer/coupon/united.h"
#include "slicer/mesh/boundary.h"
#include "slicer/mesh/crossings.h"
#include "slicer/mesh/read/read_mesh.h"
#include "slicer/mesh/repair.h"
#include "slicer/mesh/shells.h"
#include "slicer/voxels/voxelize.h"
#include "tests/support/program.h"

namespace binderjet {
namespace {

constexpr double kVoxelMm = 0.02;

// The slices of a coupon at 20 um, 0.1 mm apart.
std::vector<RunLayer> slices(CouponKind kind) {
  auto mesh = std::make_shared<const Mesh>(coupon(kind));
  const Box box = bounding_box(*mesh);
  EXPECT_EQ(box.min[2], 0);
  Mesh moved = *mesh;
  for (Point& p : moved.points) {
    for (std::size_t a = 0; a < 3; ++a) p[a] -= box.min[a];
  }
  const Grid grid{{kVoxelMm, kVoxelMm, 0.1}, {1, 1, 1}};
  const JobBox job = job_box({box.size(0), box.size(1), box.size(2)}, grid, {0, 0}, {0, 0});
  const auto stream = voxelize(std::make_shared<const Mesh>(moved), grid, job, {0, job.size_px[2]});
  std::vector<RunLayer> out;
  while (stream->rest().size() > 0) out.push_back(stream->next(1).front()->slices.front());
  return out;
}

// A column of a layer as a row.
std::vector<int> column(const RunLayer& layer, double x_mm) {
  std::vector<int> flips;
  bool solid = false;
  for (int y = 0; y <= layer.height(); ++y) {
    const bool here = layer.at(static_cast<int>(x_mm / kVoxelMm), y);
    if (here != solid) flips.push_back(y);
    solid = here;
  }
  return flips;
}

// The widths of the gaps (or runs) in a row, in mm.
std::vector<double> widths(std::span<const int> row, bool gaps) {
  std::vector<double> out;
  for (std::size_t i = gaps ? 1 : 0; i + 1 < row.size(); i += 2)
    out.push_back((row[i + 1] - row[i]) * kVoxelMm);
  return out;
}

bool holds(const std::vector<double>& all, double width) {
  return std::any_of(all.begin(), all.end(),
                     [&](double w) { return std::abs(w - width) < 1.01 * kVoxelMm; });
}

TEST(Coupon, OfThePaperHasItsTenSlots) {
  const auto layers = slices(CouponKind::kSlots);
  const RunLayer& layer = layers[20];
  const auto gaps = widths(layer.row(static_cast<int>(3 / kVoxelMm)), true);
  for (int tenth = 1; tenth <= 10; ++tenth) EXPECT_TRUE(holds(gaps, tenth / 10.0)) << tenth;
  EXPECT_EQ(gaps.size(), 11U) << "and the way to the other block";
}

TEST(Coupon, OfWallsHasFifteenBothWaysOnOnePlate) {
  const auto layers = slices(CouponKind::kWalls);
  const RunLayer& layer = layers[25];
  const auto across_x = widths(layer.row(static_cast<int>(4 / kVoxelMm)), false);
  const auto walls_y = column(layer, 4);
  for (int tenth = 1; tenth <= 15; ++tenth) {
    EXPECT_TRUE(holds(across_x, tenth / 10.0)) << tenth;
    EXPECT_TRUE(holds(widths(walls_y, false), tenth / 10.0)) << tenth;
  }
  EXPECT_EQ(column(layers[5], 4).size(), 2U) << "the plate that carries them";
}

TEST(Coupon, FullHasSlotsAndWallsOfAllWidthsBothWays) {
  const auto layers = slices(CouponKind::kFull);
  ASSERT_EQ(layers.size(), 44U);
  const RunLayer& layer = layers[40];
  const auto row = [&](double y_mm) { return layer.row(static_cast<int>(y_mm / kVoxelMm)); };
  const auto slots_y = column(layer, 28);
  const auto walls_y = column(layer, 24);
  for (const double width : {0.1, 0.3, 0.5, 0.7, 1.0, 1.5}) {
    EXPECT_TRUE(holds(widths(row(2), true), width)) << "slot across x, " << width;
    EXPECT_TRUE(holds(widths(row(6), false), width)) << "wall across x, " << width;
    EXPECT_TRUE(holds(widths(slots_y, true), width)) << "slot across y, " << width;
    EXPECT_TRUE(holds(widths(walls_y, false), width)) << "wall across y, " << width;
  }
  for (const double length : {3.0, 7.0, 14.0}) {
    EXPECT_TRUE(
        holds(widths(layers[12].row(static_cast<int>((length > 10 ? 10 : 12.5) / kVoxelMm)), false),
              length))
        << length;
  }
}

// Solid, hollow, solid again going up: the closed pocket; the open one stays hollow.
TEST(Coupon, FullHasAClosedPocketAnOpenOneAndARoof) {
  const auto layers = slices(CouponKind::kFull);
  const auto at = [&](double x, double y, double z) {
    return layers[static_cast<std::size_t>(z / 0.1)].at(static_cast<int>(x / kVoxelMm),
                                                        static_cast<int>(y / kVoxelMm));
  };
  EXPECT_TRUE(at(3.2, 21.3, 1.5));
  EXPECT_FALSE(at(3.2, 21.3, 2.5));
  EXPECT_TRUE(at(3.2, 21.3, 4));
  EXPECT_FALSE(at(9.5, 21.3, 2.5));
  EXPECT_FALSE(at(9.5, 21.3, 4));
  EXPECT_FALSE(at(8.5, 16, 2)) << "under the widest span";
  EXPECT_TRUE(at(8.5, 16, 3));
}

// As a reader of the file sees it: points are rounded to floats, and equal ones are merged.
TEST(Coupon, IsOneCleanSurface) {
  const Workplace here;
  for (const CouponKind kind : kCouponKinds) {
    SCOPED_TRACE(word(kind));
    write_stl(coupon(kind), here / "a.stl");
    Mesh mesh = read_mesh(here / "a.stl").mesh;
    EXPECT_EQ(shells_by_points(mesh).count, kind == CouponKind::kFull ? 2 : 1)
        << "full has a closed pocket";
    EXPECT_EQ(count_crossings(mesh), 0);
    const Repair repair = repair_mesh(mesh, "a.stl");
    EXPECT_THAT(repair.notes, testing::IsEmpty());
    EXPECT_THAT(repair.remarks, testing::IsEmpty());
  }
}

TEST(United, IsTheUnionOfItsShapes) {
  Mesh shapes;
  add_box(shapes, {0, 0, 0}, {4, 4, 1});
  add_box(shapes, {1, 1, 1}, {2, 2, 3});      // stands on it: a face in common
  add_box(shapes, {1.5, 1, 0.5}, {3, 2, 2});  // overlaps both, flush at y = 1 and y = 2
  const Mesh one = united(shapes);
  EXPECT_TRUE(is_closed(one));
  EXPECT_NEAR(signed_volume(one), 16 + 2 + 1, 1e-9);
  EXPECT_EQ(shells_by_points(one).count, 1);
  EXPECT_EQ(count_crossings(one), 0);
}

}  // namespace
}  // namespace binderjet
