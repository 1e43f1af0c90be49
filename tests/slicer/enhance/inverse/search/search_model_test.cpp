// SPDX-License-Identifier: GPL-3.0-or-later
// The process window as the search counts it.
#include "slicer/enhance/inverse/search/search_model.h"

#include <gtest/gtest.h>

#include "slicer/model/process_window.h"

namespace binderjet {
namespace {

const Grid kWindowGrid{{0.1, 0.1, 0.1}, {2, 2, 2}};
const EffectList kSpreadAndLevel{{"spread", {{"shape", "box"}}, {{"width_mm", {0.7, 0.5}}}},
                                 {"threshold", {}, {{"level", {0.5}}}}};

// The printer, and a narrower and a wider spread with two levels each.
TEST(SearchModel, ComparesOneDoseWithEachLevelOfItsSpread) {
  const SearchModel model(process_window(kSpreadAndLevel, kWindowGrid), {}, kWindowGrid);
  ASSERT_EQ(model.models.size(), 3U);
  ASSERT_EQ(model.models[0].levels.size(), 1U);
  EXPECT_EQ(model.models[0].levels[0].weight, kNominalWeight);
  for (const std::size_t drifted : {1U, 2U}) {
    const std::vector<DoseLevel>& levels = model.models[drifted].levels;
    ASSERT_EQ(levels.size(), 2U);
    // A wider spread moves an edge farther than a narrower one.
    const bool wider = drifted == 2;
    EXPECT_EQ(levels[0].weight, wider ? kFarCornerWeight : 1);
    EXPECT_EQ(levels[1].weight, wider ? kFarCornerWeight : 1);
    EXPECT_NE(levels[0].least < model.models[0].levels[0].least,
              levels[1].least < model.models[0].levels[0].least);
  }
}

// At a low level an edge lies where the wide spread and the low level move it the same way.
TEST(SearchModel, WeighsTheCornersThatMoveAnEdgeFarthest) {
  EffectList low = kSpreadAndLevel;
  low.back().numbers.at("level") = {0.25};
  const auto window = process_window(low, kWindowGrid);
  const SearchModel model(window, {}, kWindowGrid);
  const int nominal = model.models[0].levels[0].least;
  for (const std::size_t drifted : {1U, 2U}) {
    for (const DoseLevel& level : model.models[drifted].levels) {
      const bool wide = drifted == 2;
      const bool outwards = level.least < nominal;
      EXPECT_EQ(level.weight, wide == outwards ? kFarCornerWeight : 1) << drifted << level.least;
    }
  }
}

TEST(SearchModel, HasAUnitThatLeavesRoomForAllItsTerms) {
  const PrinterModel one(kSpreadAndLevel, kWindowGrid);
  EXPECT_EQ(SearchModel({&one, 1}, {}, kWindowGrid).unit, 8192);
  AssembledModel form = one.form();
  form.terms.push_back(form.terms.front());
  form.terms.back().layer = 1;
  const PrinterModel two(form, kWindowGrid);
  EXPECT_EQ(SearchModel({&two, 1}, {}, kWindowGrid).unit, 4096);
}

}  // namespace
}  // namespace binderjet
