// SPDX-License-Identifier: GPL-3.0-or-later
// Slots and walls of a gauge, predicted by the real model, and the change of it that agrees.
#include "slicer/calibrate/gauges/gauge_slots.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "slicer/base/error.h"
#include "tests/support/program.h"

namespace binderjet {
namespace {

using testing::HasSubstr;

const Grid kZ450Grid{{25.4 / 300, 25.4 / 450, 0.102}, {2, 2, 2}};

std::vector<EffectSpec> box(double x_mm, double y_mm, double level) {
  return {{"spread", {{"shape", "box"}}, {{"width_mm", {x_mm, y_mm}}}},
          {"threshold", {}, {{"level", {level}}}}};
}

// The dose in the middle of a slot of width w is 1 - w / box, so it opens at (1 - level) box; and a
// wall stands from level * box on.
TEST(GaugeStrip, OpensASlotWhereTheBoxLeavesIt) {
  for (const double level : {0.2, 0.5, 0.7}) {
    const PrinterModel model(box(0.7, 0.3, level), kZ450Grid);
    for (const int axis : {0, 1}) {
      const double width = axis == 0 ? 0.7 : 0.3;
      // Slicing moves each of the two faces by up to half a pixel.
      const double grid = kZ450Grid.pitch_mm[static_cast<std::size_t>(axis)];
      EXPECT_NEAR(visible_from_mm(model, kZ450Grid, GaugeKind::kSlot, axis, 5), (1 - level) * width,
                  grid);
      EXPECT_NEAR(visible_from_mm(model, kZ450Grid, GaugeKind::kWall, axis, 5), level * width,
                  grid);
    }
  }
}

TEST(GaugeStrip, KeepsAWideWallAtHalfAndGrowsItBelow) {
  const double tie =
      kZ450Grid.voxel_mm(0);  // half a pixel counts as solid (slots.csv: half a voxel a face)
  const PrinterModel half(box(0.7, 0.3, 0.5), kZ450Grid);
  EXPECT_NEAR(print_gauge(half, kZ450Grid, GaugeKind::kWall, 0, 3).mean_mm, 3, 1.1 * tie);
  // A face moves by (0.5 - level) * box.
  const PrinterModel low(box(0.7, 0.3, 0.25), kZ450Grid);
  EXPECT_NEAR(print_gauge(low, kZ450Grid, GaugeKind::kWall, 0, 3).mean_mm, 3.35, 1.1 * tie);
  EXPECT_NEAR(print_gauge(low, kZ450Grid, GaugeKind::kSlot, 0, 3).mean_mm, 2.65, 1.1 * tie);
}

TEST(GaugeStrip, SeesALayersSlotWhereNothingSinks) {
  const PrinterModel model(box(0.7, 0.3, 0.5), kZ450Grid);
  EXPECT_NEAR(visible_from_mm(model, kZ450Grid, GaugeKind::kSlot, 2, 5), 0.102, 0.03);
  EXPECT_NEAR(print_gauge(model, kZ450Grid, GaugeKind::kWall, 2, 1.02).mean_mm, 1.02, 0.052);
}

// measured/slot_visibility_model.csv: with the paper's kernel and a level of 0.5 a slot of 0.5 mm
// in x is open at all places, one of 0.4 mm at a quarter, one of 0.3 mm nowhere.
TEST(GaugeStrip, AgreesWithThePapersOwnTableOfSlots) {
  const PrinterModel model(box(16 * 25.4 / 600, 10 * 25.4 / 900, 0.5), kZ450Grid);
  EXPECT_EQ(print_gauge(model, kZ450Grid, GaugeKind::kSlot, 0, 0.3).visible_share, 0);
  EXPECT_NEAR(print_gauge(model, kZ450Grid, GaugeKind::kSlot, 0, 0.4).visible_share, 0.25, 0.13);
  EXPECT_EQ(print_gauge(model, kZ450Grid, GaugeKind::kSlot, 0, 0.5).visible_share, 1);
  EXPECT_NEAR(print_gauge(model, kZ450Grid, GaugeKind::kSlot, 0, 0.5).mean_mm, 0.418,
              kZ450Grid.voxel_mm(0))
      << "the table's even box lies half a voxel off";
}

class Slots : public testing::Test {
 protected:
  std::vector<GaugeReading> read(const std::string& text) const {
    std::ofstream(place_ / "g.csv") << text;
    return read_slots(read_gauge_table(place_ / "g.csv"));
  }
  Workplace place_;
};

TEST_F(Slots, AloneLeaveLevelAndWidthAsRivalsAndSayWhatWouldTell) {
  const SlotFindings found = trace_slots(
      read("axis,first_visible_slot_mm_low,first_visible_slot_mm_high\nx,0.6,0.7\ny,0.3,0.3\n"),
      box(0.7, 0.3, 0.5), kZ450Grid);
  EXPECT_FALSE(found.declared_agrees);
  EXPECT_NEAR(found.readings[0].measured_mm - found.declared_mm[0], 0.2, 0.05);
  ASSERT_EQ(found.explanations.size(), 2U);
  const Explanation& level = found.explanations[0];
  const Explanation& width = found.explanations[1];
  EXPECT_EQ(level.kind, "threshold");
  EXPECT_TRUE(level.agrees);
  EXPECT_LE(level.low, 0.25);
  EXPECT_GE(level.high, 0.25);
  EXPECT_LT(level.high, 0.5);
  EXPECT_EQ(width.kind, "kernel_x");
  EXPECT_TRUE(width.agrees);
  EXPECT_LE(width.low, 1.8);
  EXPECT_GE(width.high, 1.8);
  EXPECT_LT(level.rms_mm, found.declared_rms_mm / 2);
  ASSERT_FALSE(found.discriminators.empty());
  EXPECT_THAT(found.discriminators[0].gauge, HasSubstr("wall"));
  EXPECT_GT(found.discriminators[0].difference_mm, 0.3);
}

TEST_F(Slots, WithAWallNameTheWidth) {
  // What a box twice as wide prints: slots from 0.7 mm, no wall below that, faces where they were.
  const SlotFindings found =
      trace_slots(read("gauge,axis,nominal_mm,visible,measured_mm,uncertainty_mm\n"
                       "slot,x,0.6,0,,\nslot,x,0.8,1,,\nwall,x,0.6,0,,\nwall,x,0.8,1,,\n"
                       "wall,x,2,,2.05,0.05\n"),
                  box(0.7, 0.3, 0.5), kZ450Grid);
  ASSERT_FALSE(found.explanations.empty());
  EXPECT_EQ(found.explanations[0].kind, "kernel_x");
  EXPECT_TRUE(found.explanations[0].agrees);
  EXPECT_NEAR(found.explanations[0].value, 2, 0.2);
  EXPECT_FALSE(found.explanations[1].agrees);
}

TEST_F(Slots, ThatTheModelPredictsNeedNoEffect) {
  const SlotFindings found =
      trace_slots(read("gauge,axis,nominal_mm,visible\nslot,x,0.3,0\nslot,x,0.5,1\n"),
                  box(0.7, 0.3, 0.5), kZ450Grid);
  EXPECT_TRUE(found.declared_agrees);
  EXPECT_TRUE(found.explanations.empty());
}

TEST_F(Slots, AreRefusedWithTheLine) {
  const auto refusal = [&](const std::string& text) -> std::string {
    try {
      read(text);
    } catch (const Error& error) {
      return error.what();
    }
    return {};
  };
  EXPECT_THAT(refusal("axis,first_visible_slot_mm_low,first_visible_slot_mm_high\nq,1,1\n"),
              HasSubstr("g.csv:2: \"q\" in column axis"));
  EXPECT_THAT(refusal("axis,first_visible_slot_mm_low,first_visible_slot_mm_high\nx,1,0.5\n"),
              HasSubstr("g.csv:2: "));
  EXPECT_THAT(refusal("gauge,axis,nominal_mm,visible\nslot,x,0.3,1\nslot,x,0.5,0\n"),
              HasSubstr("0.3 mm is seen and 0.5 mm is not"));
  EXPECT_THAT(refusal("gauge,axis,nominal_mm,visible\nhole,x,0.3,1\n"), HasSubstr("g.csv:2: "));
  EXPECT_THAT(refusal("gauge,axis,nominal_mm,visible\nslot,x,0.3,yes\n"), HasSubstr("g.csv:2: "));
}

}  // namespace
}  // namespace binderjet
