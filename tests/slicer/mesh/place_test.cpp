// SPDX-License-Identifier: GPL-3.0-or-later
// Exact scaling and quarter turns, spots at pixel corners, and advice with numbers.
#include "slicer/mesh/place.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "slicer/base/error.h"
#include "tests/slicer/mesh/samples.h"

namespace binderjet {
namespace {

using testing::box;
using testing::error_of;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

const Bed kBed{{203, 254, 204}, {25.4 / 300, 25.4 / 450}};

BedRequest request(Point size, std::optional<std::array<double, 2>> at = {}) {
  return {"part.stl", size, at, false, 1.0};
}

std::string error_placing(const std::vector<BedRequest>& parts) {
  return error_of([&] { place_parts(parts, kBed, 2); });
}

TEST(Place, ScalesByOneMultiplication) {
  Mesh mesh = box(0.1, {0.3, -7.7, 1e-3});
  const Mesh before = mesh;
  transform_mesh(mesh, 25.4 * 0.7, {0, 0, 0});
  for (std::size_t i = 0; i < mesh.points.size(); ++i) {
    for (std::size_t a = 0; a < 3; ++a) {
      EXPECT_EQ(mesh.points[i][a], before.points[i][a] * (25.4 * 0.7));
    }
  }
}

TEST(Place, TurnsAboutXThenYThenZ) {
  Mesh mesh;
  mesh.points = {{0.1, 0.2, 0.3}};
  transform_mesh(mesh, 1, {90, 0, 0});
  EXPECT_EQ(mesh.points[0], (Point{0.1, -0.3, 0.2}));
  transform_mesh(mesh, 1, {0, 90, 0});
  EXPECT_EQ(mesh.points[0], (Point{0.2, -0.3, -0.1}));
  transform_mesh(mesh, 1, {0, 0, 90});
  EXPECT_EQ(mesh.points[0], (Point{0.3, 0.2, -0.1}));
  Mesh at_once;
  at_once.points = {{0.1, 0.2, 0.3}};
  transform_mesh(at_once, 1, {90, 90, 90});
  EXPECT_EQ(at_once.points, mesh.points);
}

RC_GTEST_PROP(Place, QuarterTurnsAreExactAndOthersKeepLengths, ()) {
  const auto coordinate = [] { return *rc::gen::inRange(-1'000'000, 1'000'000) / 777.0; };
  const double x = coordinate();
  const double y = coordinate();
  const double z = coordinate();
  Mesh mesh;
  mesh.points = {{x, y, z}};
  for (const double angle : {90.0, 180.0, -270.0, 360.0, 450.0, -450.0}) {
    transform_mesh(mesh, 1, {angle, 0, angle});
    transform_mesh(mesh, 1, {0, 0, -angle});
    transform_mesh(mesh, 1, {-angle, 0, 0});
    RC_ASSERT(mesh.points[0] == (Point{x, y, z}));
  }
  transform_mesh(mesh, 1, {12.5, -33, 71});
  const Point& p = mesh.points[0];
  const double length = std::hypot(x, y, z);
  RC_ASSERT(std::abs(std::hypot(p[0], p[1], p[2]) - length) <= 1e-14 * length);
}

TEST(Place, PutsTheLowerCornerAtExactlyZero) {
  Mesh mesh = box(0.1, {0.7, -1e6, 1e-9});
  Placement placement;
  placement.unit_mm = 25.4;
  placement.scale = 1.1;
  placement.rotate_deg = {10, 20, 30};
  const Point size = transform_part(mesh, placement, "a.stl");
  EXPECT_EQ(bounding_box(mesh).min, (Point{0, 0, 0}));
  EXPECT_EQ(bounding_box(mesh).max, size);
  placement.scale = 0;
  EXPECT_THAT(error_of([&] { transform_part(mesh, placement, "a.stl"); }), HasSubstr("--scale"));
}

TEST(Place, StandsInTheMiddleOrAtTheNearestPixelCorner) {
  const BedSpot middle = place_parts({request({94.1, 144, 124.7})}, kBed, 2)[0];
  EXPECT_EQ(middle.x_px, 643);  // (203 - 94.1) / 2 = 54.45 mm, 643.1 pixels
  EXPECT_EQ(middle.y_px, 974);  // (254 - 144) / 2 = 55 mm, 974.4 pixels
  const BedSpot at = place_parts({request({10, 10, 10}, {{10, 20}})}, kBed, 2)[0];
  EXPECT_EQ(at.x_px, 118);  // 118.1
  EXPECT_EQ(at.y_px, 354);  // 354.3
}

TEST(Place, FillsTheBedToItsLastPixel) {
  EXPECT_EQ(kBed.pixels(0), 2398);  // 203 mm are 2397.6 pixels
  EXPECT_EQ(kBed.pixels(1), 4500);  // 254 mm are 4500 pixels but for rounding
  const BedSpot spot = place_parts({request({203, 254, 204})}, kBed, 2)[0];
  EXPECT_EQ(spot.x_px, 0);
  EXPECT_EQ(spot.y_px, 0);
  EXPECT_THAT(error_placing({request({203.1, 10, 10})}), HasSubstr("does not fit"));
  EXPECT_THAT(error_placing({request({10, 254.001, 10})}), HasSubstr("does not fit"));
}

// The bed's last pixel reaches 0.027 mm over its edge, a part beside others must not.
TEST(Place, EndsOnTheBedAlsoInItsLastPixel) {
  const double beside = 203 - 2135 * kBed.pitch_mm[0];  // ends with the bed from pixel 2135
  EXPECT_EQ(place_parts({request({10, 20, 5}, {{0, 0}}), request({beside, 10, 5}, {{180.8, 0}})},
                        kBed, 2)[1]
                .x_px,
            2135);
  EXPECT_THAT(error_placing(
                  {request({10, 20, 5}, {{0, 0}}), request({beside + 0.01, 10, 5}, {{180.8, 0}})}),
              HasSubstr("off the bed"));
  // 180.6 mm and the gap are 2158 pixels; what is left is 20.285 mm.
  const std::vector<BedSpot> row =
      place_parts({request({180.6, 20, 5}), request({20.28, 10, 5})}, kBed, 2);
  EXPECT_EQ(row[0].y_px, row[1].y_px);
  const std::vector<BedSpot> rows =
      place_parts({request({180.6, 20, 5}), request({20.3, 10, 5})}, kBed, 2);
  EXPECT_LT(rows[0].y_px, rows[1].y_px);
}

TEST(Place, SaysWhichScaleOrTurnWouldFit) {
  EXPECT_THAT(
      error_placing({request({300, 150.02, 120})}),
      HasSubstr("part.stl: 300.0 x 150.0 x 120.0 mm does not fit the bed of 203 x 254 x 204 "
                "mm; --scale 0.67 would"));
  EXPECT_THAT(error_placing({request({250, 150, 120})}), HasSubstr("turn by 90 degrees about z"));
  EXPECT_THAT(error_placing({request({94100, 144000, 124700})}), HasSubstr("--units um"));
  BedRequest scaled = request({300, 150, 120});
  scaled.scale = 2;
  EXPECT_THAT(error_placing({scaled}), HasSubstr("--scale 1.3 would"));
}

TEST(Place, RefusesAWishOffTheBedOrInAnotherPart) {
  EXPECT_THAT(error_placing({request({100, 10, 10}, {{150, 20}})}),
              HasSubstr("at 150,20 it reaches 250.0,30.0 mm, off the bed"));
  EXPECT_THAT(error_placing({request({100, 10, 10}, {{-1, 20}})}), HasSubstr("off the bed"));
  EXPECT_THAT(error_placing({request({50, 50, 10}, {{0, 0}}), request({50, 50, 10}, {{49, 0}})}),
              HasSubstr("stands in part.stl"));
}

TEST(Place, WarnsOfAPartTooSmallToBeMeant) {
  EXPECT_THAT(doubtful_size(request({0.044, 0.014, 0.047})),
              HasSubstr("probably in meters: say --units m (44.0 x 14.0 x 47.0 mm)"));
  EXPECT_THAT(doubtful_size(request({0.9, 0.5, 0.5})),
              HasSubstr("probably in inches: say --units in (22.9 x 12.7 x 12.7 mm)"));
  EXPECT_THAT(doubtful_size(request({20, 0.5, 0.5})), IsEmpty());
}

TEST(Place, KnowsTheUnitsOfTheTrade) {
  EXPECT_EQ(unit_from_word("in"), 25.4);
  EXPECT_EQ(unit_from_word("um"), 0.001);
  EXPECT_EQ(unit_from_word("parsec"), std::nullopt);
}

bool overlap(BedSpot a, Point size_a, BedSpot b, Point size_b, double gap_mm) {
  const double px = kBed.pitch_mm[0];
  const double py = kBed.pitch_mm[1];
  return a.x_px * px < b.x_px * px + size_b[0] + gap_mm - 1e-6 &&
         b.x_px * px < a.x_px * px + size_a[0] + gap_mm - 1e-6 &&
         a.y_px * py < b.y_px * py + size_b[1] + gap_mm - 1e-6 &&
         b.y_px * py < a.y_px * py + size_a[1] + gap_mm - 1e-6;
}

RC_GTEST_PROP(Place, KeepsSeveralPartsApartAndOnTheBed, ()) {
  std::vector<BedRequest> parts;
  if (*rc::gen::arbitrary<bool>()) parts.push_back(request({30, 40, 5}, {{80, 100}}));
  const int count = *rc::gen::inRange(1, 12);
  for (int i = 0; i < count; ++i) {
    // Two of the widest fill a row up to the bed's edge.
    parts.push_back(
        request({*rc::gen::inRange(1, 900) / 9.0, *rc::gen::inRange(1, 200) / 9.0, 10}));
  }
  const std::vector<BedSpot> spots = place_parts(parts, kBed, 2);
  for (std::size_t i = 0; i < parts.size(); ++i) {
    RC_ASSERT(spots[i].x_px >= 0 && spots[i].y_px >= 0);
    RC_ASSERT(spots[i].x_px * kBed.pitch_mm[0] + parts[i].size_mm[0] <= 203 + 1e-6);
    RC_ASSERT(spots[i].y_px * kBed.pitch_mm[1] + parts[i].size_mm[1] <= 254 + 1e-6);
    for (std::size_t j = 0; j < i; ++j) {
      RC_ASSERT(!overlap(spots[i], parts[i].size_mm, spots[j], parts[j].size_mm, 2));
    }
  }
}

TEST(Place, SaysHowManyPartsFoundRoom) {
  const std::vector<BedRequest> parts(5, request({120, 120, 10}));
  EXPECT_THAT(error_placing(parts), HasSubstr("finds no room beside the 2 of 5 parts"));
}

}  // namespace
}  // namespace binderjet
