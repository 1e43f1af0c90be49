// SPDX-License-Identifier: GPL-3.0-or-later
// Gauge tables are read strictly: a slip of the pen is named with file and line.
#include "slicer/calibrate/gauges/gauge_table.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "slicer/base/error.h"
#include "tests/support/program.h"

namespace binderjet {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

class Gauges : public testing::Test {
 protected:
  GaugeTable read(const std::string& text) const {
    std::ofstream(place_ / "g.csv") << text;
    return read_gauge_table(place_ / "g.csv");
  }
  std::string refusal(const std::string& text) const {
    try {
      const GaugeTable table = read(text);
      for (const GaugeTable::Row& row : table.rows) table.number(row, "a");
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::kBadInput);
      return error.what();
    }
    return {};
  }
  Workplace place_;
};

TEST_F(Gauges, KeepsRemarksQuotesAndLineNumbers) {
  const GaugeTable table =
      read("# made by hand\r\n\na,b\r\n 1.5 ,\"x, \"\"y\"\"\"\n# more\n-2e-1,\n");
  EXPECT_THAT(table.remarks, ElementsAre("made by hand", "more"));
  EXPECT_THAT(table.header, ElementsAre("a", "b"));
  ASSERT_EQ(table.rows.size(), 2U);
  EXPECT_EQ(table.number(table.rows[0], "a"), 1.5);
  EXPECT_EQ(table.text(table.rows[0], "b"), "x, \"y\"");
  EXPECT_EQ(table.rows[1].line, 6);
  EXPECT_EQ(table.number(table.rows[1], "a"), -0.2);
}

TEST_F(Gauges, AreRefusedWithTheLine) {
  EXPECT_THAT(refusal("a,b\n1,2\n3\n"), HasSubstr("g.csv:3: has 1 cells, the header has 2"));
  EXPECT_THAT(refusal("a,b\n1,2\n1.2mm,3\n"), HasSubstr("g.csv:3: \"1.2mm\" in column a"));
  EXPECT_THAT(refusal("a,b\nnan,2\n"), HasSubstr("g.csv:2: "));
  EXPECT_THAT(refusal("a,b\n,2\n"), HasSubstr("g.csv:2: "));
  EXPECT_THAT(refusal("a,a\n1,2\n"), HasSubstr("g.csv:1: names a column twice"));
  EXPECT_THAT(refusal("a,b\n1,\"2\n"), HasSubstr("g.csv:2: a quote"));
  EXPECT_THAT(refusal("a,b\n"), HasSubstr("holds no rows"));
  EXPECT_THAT(refusal("b\n1\n"), HasSubstr("has no column a"));
  EXPECT_THAT(refusal("a\n1\n-1e308\n"), HasSubstr("g.csv:3: \"-1e308\" in column a is beyond"));
  std::string many = "a\n";
  for (int row = 0; row < 5000; ++row) many += "1\n";
  EXPECT_EQ(refusal(many), "");
  EXPECT_THAT(refusal(many + "1\n"), HasSubstr("g.csv:5002: is one row more than the 5000"));
  EXPECT_THROW(read_gauge_table(place_ / "absent.csv"), Error);
}

}  // namespace
}  // namespace binderjet
