// SPDX-License-Identifier: GPL-3.0-or-later
// The corners of a printer's process window.
#include "slicer/model/process_window.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

namespace binderjet {
namespace {

const Grid kHalfPixels{{0.1, 0.1, 0.1}, {2, 2, 2}};

EffectSpec spread(double width_mm) {
  return {"spread", {{"shape", "box"}}, {{"width_mm", {width_mm, width_mm}}}};
}
EffectSpec threshold(double level) { return {"threshold", {}, {{"level", {level}}}}; }

TEST(ProcessWindow, IsTheModelAndSpreadTenPercentAndLevelAFiveHundredthOff) {
  const auto models = process_window({spread(1), threshold(0.25)}, kHalfPixels);
  ASSERT_EQ(models.size(), 5U);
  EXPECT_EQ(models.front().form().level, 0.25);
  std::set<std::pair<int, int>> corners;  // level in 1/100, kernel reach
  for (std::size_t m = 1; m < models.size(); ++m) {
    const AssembledModel& form = models[m].form();
    corners.emplace(static_cast<int>(std::lround(100 * form.level)), form.terms[0].x.last());
  }
  // Boxes of 18 and 22 voxels reach 9 and 11 from the middle one.
  EXPECT_EQ(corners, (std::set<std::pair<int, int>>{{20, 9}, {20, 11}, {30, 9}, {30, 11}}));
}

TEST(ProcessWindow, StaysWithinWhatAParameterMayBe) {
  const auto models = process_window({threshold(0.97)}, kHalfPixels);
  ASSERT_EQ(models.size(), 3U);
  EXPECT_NEAR(models[1].form().level, 0.92, 1e-12);
  EXPECT_EQ(models[2].form().level, 0.97) << "1.02 would bind nothing";
}

}  // namespace
}  // namespace binderjet
