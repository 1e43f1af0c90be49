// SPDX-License-Identifier: GPL-3.0-or-later
// A candidate is judged by what it predicts where it was not fitted.
#include "slicer/calibrate/choice/regression.h"

#include <gtest/gtest.h>

#include "slicer/calibrate/residual/printed_error.h"

namespace binderjet {
namespace {

// One column of ones, and a residual of so much in each cell.
regression::Normal normal_of(double in_first, double in_others) {
  regression::Normal normal;
  normal.gram.assign(kCells, regression::Matrix::Identity(1, 1));
  normal.right.assign(kCells, regression::Vector::Constant(1, in_others));
  normal.right.front()[0] = in_first;
  return normal;
}

TEST(Regression, HoldsAgainstACandidateThatItFitsOneCellOnly) {
  const regression::Score score = regression::score_of(Candidate{}, normal_of(1, 0), 1);
  EXPECT_TRUE(score.usable);
  EXPECT_LT(score.held_out, 0) << "what the one cell teaches is wrong in all the others";
}

TEST(Regression, TakesWhatIsTheSameEverywhere) {
  const regression::Score score = regression::score_of(Candidate{}, normal_of(1, 1), kCells);
  EXPECT_NEAR(score.held_out, 1, 1e-5) << "all of the residual";
  EXPECT_TRUE(score.folds_agree);
}

}  // namespace
}  // namespace binderjet
