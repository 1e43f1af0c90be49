// SPDX-License-Identifier: GPL-3.0-or-later
// Lengths give back the growth, the slip and the bed's slope that were put into them, and no more.
#include "slicer/calibrate/gauges/gauge_lengths.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <iostream>
#include <random>

#include "slicer/base/error.h"
#include "tests/support/caliper_readings.h"
#include "tests/support/program.h"

namespace binderjet {
namespace {

using testing::HasSubstr;

class Lengths : public testing::Test {
 protected:
  LengthFindings trace(const MeasuredBlocks& printer, unsigned seed = 1) const {
    write_readings(place_ / "g.csv", printer, seed);
    return trace_lengths(read_gauge_table(place_ / "g.csv"), {});
  }
  static const Rung& rung(const LengthFindings& found, const std::string& name) {
    for (const Rung& one : found.ladder.rungs) {
      if (one.name == name) return one;
    }
    throw std::runtime_error("no rung " + name);
  }
  // The coefficient of the column whose name holds `part`.
  static double number(const LengthFindings& found, const std::string& term,
                       const std::string& part) {
    for (std::size_t i = 0; i < found.ladder.columns.size(); ++i) {
      const auto& column = found.ladder.columns[i];
      if (column.term == term && column.name.find(part) != std::string::npos) {
        return found.ladder.coefficients[static_cast<Eigen::Index>(i)];
      }
    }
    return std::nan("");
  }
  Workplace place_;
};

TEST_F(Lengths, TellAnOffsetFromAScale) {
  const LengthFindings offset = trace({});
  EXPECT_EQ(rung(offset, "growth per batch").form, "offset");
  EXPECT_EQ(offset.offset_batches(), 4);
  MeasuredBlocks scales;
  scales.offset_mm = -0.25;  // with the batches' own growth, none on average
  scales.scale = 0.04;
  const LengthFindings scale = trace(scales);
  EXPECT_EQ(rung(scale, "growth per batch").form, "scale");
  EXPECT_EQ(scale.offset_batches(), 0);
}

TEST_F(Lengths, FindTheSlipAndTheSlopeOnTheirAxes) {
  MeasuredBlocks printer;
  printer.slip_y_mm = 0.2;
  printer.column_mm = 0.15;
  const LengthFindings found = trace(printer);
  EXPECT_TRUE(rung(found, "layer shift").accepted);
  EXPECT_EQ(rung(found, "layer shift").form, "along y");
  EXPECT_NEAR(number(found, "layer shift", "reading 3"), 0.2, 0.03);
  EXPECT_NEAR(number(found, "layer shift", "reading 2"), 0, 0.03);
  EXPECT_TRUE(rung(found, "place on the bed").accepted);
  EXPECT_EQ(rung(found, "place on the bed").form, "4 parts to a column");
  EXPECT_NEAR(number(found, "place on the bed", "x"), 0.15, 0.04);
  EXPECT_FALSE(rung(found, "layer shift per batch").accepted);
  EXPECT_NEAR(found.floor_rms, 0.07, 0.03) << "readings scatter by 0.05, and slip";
}

// A part's readings lean on each other; a judge that forgot it would find slopes in parts' own
// errors. Nothing but growth is there, and t >= 2 lets about one in forty through.
TEST_F(Lengths, ClaimNothingWhereNothingIs) {
  std::random_device device;
  const unsigned seed = device();
  std::cout << "seed " << seed << '\n';
  int claims = 0;
  constexpr int kTables = 60;
  for (unsigned i = 0; i < kTables; ++i) {
    for (const Rung& one : trace({}, seed + i).ladder.rungs) {
      if (one.accepted && one.name.rfind("growth", 0) != 0) ++claims;
    }
  }
  std::cout << claims << " false claims in " << kTables << " tables\n";
  EXPECT_LE(claims, 9);  // three questions each; more than 9 of 180 would be one in twenty
}

TEST_F(Lengths, DropABrokenBatchAndRowsThatAreFarOff) {
  write_readings(place_ / "g.csv", {}, 2);
  std::ofstream file(place_ / "g.csv", std::ios::app);
  for (int part = 1; part <= 8; ++part) {
    file << fmt::format("5,{},1,20,15,10,{},15.5,10.5\n", part, part <= 5 ? 4.0 : 20.5);
  }
  file << "1,3,1,20,15,10,24.5,15.5,10.5\n";
  file.close();
  const LengthFindings found = trace_lengths(read_gauge_table(place_ / "g.csv"), {});
  EXPECT_EQ(found.rows, 96 + 9);
  EXPECT_EQ(found.used_rows, 96);
  ASSERT_EQ(found.dropped.size(), 2U);
  EXPECT_THAT(found.dropped[0], HasSubstr("batch 5: broken, 5 of its 8 rows"));
  EXPECT_THAT(found.dropped[1], HasSubstr("line 107"));
}

TEST_F(Lengths, AreRefusedWithTheLine) {
  std::ofstream(place_ / "g.csv") << "part,nominal_x,meas_x\n1,20,20.5\n2,0,20.5\n";
  try {
    trace_lengths(read_gauge_table(place_ / "g.csv"), {});
    FAIL() << "a nominal length of 0 was taken";
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), HasSubstr("g.csv:3: "));
  }
  std::ofstream(place_ / "g.csv") << "part,nominal_x,meas_x\n1,20,20.5\n2,20,20.5\n";
  EXPECT_THROW(trace_lengths(read_gauge_table(place_ / "g.csv"), {}), Error);
}

// 285 real caliper rows of green 316L blocks. Held out by part, notes/calibration.md has by hand:
// nominal 0.857, growth per batch 0.357, per axis 0.342, layer shift 0.329, bed column 0.311, layer
// shift per batch 0.310 and rejected. Its folds are not known; these leave one part out.
TEST_F(Lengths, ReproduceTheTableOfTheCaliperRows) {
  const std::filesystem::path data = data_folder();
  if (data.empty()) GTEST_SKIP() << "the measured data are not here";
  const LengthFindings found =
      trace_lengths(read_gauge_table((data / "measured/bj_316L_doe_dimensions.csv").string()), {});
  EXPECT_EQ(found.rows, 285);
  EXPECT_NEAR(found.ladder.rms_without, 0.857, 0.0005);
  const std::vector<std::pair<std::string, double>> by_hand = {{"growth per batch", 0.357},
                                                               {"growth per batch and axis", 0.342},
                                                               {"layer shift", 0.329},
                                                               {"place on the bed", 0.311},
                                                               {"layer shift per batch", 0.310}};
  for (const auto& [name, rms] : by_hand) {
    EXPECT_NEAR(rung(found, name).rms, rms, 0.005) << name;
    EXPECT_EQ(rung(found, name).accepted, name != "layer shift per batch") << name;
  }
  EXPECT_EQ(rung(found, "growth per batch").form, "offset");
  EXPECT_EQ(found.offset_batches(), 9);
  EXPECT_EQ(found.growth.size(), 11U);
  EXPECT_EQ(rung(found, "layer shift").form, "along x");
  EXPECT_NEAR(number(found, "place on the bed", "x"), 0.159, 0.01);
  EXPECT_GT(rung(found, "place on the bed").median, rung(found, "layer shift").median)
      << "the usual part gets worse, and the report has to show it";
}

}  // namespace
}  // namespace binderjet
