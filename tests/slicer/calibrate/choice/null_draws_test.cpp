// SPDX-License-Identifier: GPL-3.0-or-later
// What a gain in cells is worth, on gains that are known.
#include "slicer/calibrate/choice/null_draws.h"

#include <gtest/gtest.h>

#include <array>

#include "slicer/calibrate/calibrate.h"
#include "slicer/calibrate/residual/printed_error.h"
#include "slicer/model/effects/candidates.h"

namespace binderjet {
namespace {

using Slabs = std::array<double, kSlabs>;

std::vector<double> gain_in(int cells) {
  std::vector<double> gain(kCells, 0);
  std::fill_n(gain.begin(), cells, 1.0);
  return gain;
}

double p_of(const std::vector<double>& gain) {
  const std::array<const std::vector<double>*, 1> family{&gain};
  return p_over_all_gains(family, sum_of_cells(gain));
}

TEST(SignFlips, AreNoSurerOfAFewCellsThanTheirCoinsCanBe) {
  // All of k coins fall alike in 2^-k of the draws; 499 draws put that off by 0.02 at most (2
  // deviations at 1/32).
  EXPECT_NEAR(p_of(gain_in(1)), 0.5, 0.05);
  EXPECT_NEAR(p_of(gain_in(5)), 1.0 / 32, 0.02);
  EXPECT_LE(p_of(gain_in(20)), 0.01);
}

TEST(SignFlips, CountTheWholeFamilyAgainstTheBest) {
  std::vector<double> other(kCells, 0);
  other.back() = 6;
  const std::vector<double> best = gain_in(5);
  const std::array<const std::vector<double>*, 2> family{&best, &other};
  EXPECT_GE(p_over_all_gains(family, 5), 0.45) << "the other has as much in every second draw";
}

TEST(CalibrationLimits, AskForSizeWhereFewCellsCannotBeSure) {
  const CalibrationLimits limits;
  EXPECT_TRUE(limits.sure(0.01, 0.02));
  EXPECT_FALSE(limits.sure(0.03, 0.05)) << "neither sure nor large";
  EXPECT_TRUE(limits.sure(0.03, 0.2));
  EXPECT_FALSE(limits.sure(0.06, 0.9)) << "large, but of no more than four cells";
}

TEST(Slabs, AgreeThoughMostHaveNothingToActOn) {
  EXPECT_TRUE(most_agree(Slabs{50, 50, -0.5, -0.5, -0.5}));
  EXPECT_TRUE(most_agree(Slabs{50, 50, 50, 50, -40}));
}

TEST(Slabs, DisagreeWhereTwoLose) {
  EXPECT_FALSE(most_agree(Slabs{50, 50, -5, -5, 0}));
  EXPECT_FALSE(most_agree(Slabs{1, 1, 1, 1, -10})) << "all in all a loss";
}

TEST(Slabs, MayDisagreeOnlyAlongAnAxisThatTheEffectFollows) {
  // All of it in the lower two slabs of z, and a loss in the others.
  std::vector<double> gain(kCells);
  for (int k = 0; k < kCells; ++k) {
    gain[static_cast<std::size_t>(k)] = slab_of_cell(k, 2) < 2 ? 1 : -0.1;
  }
  EXPECT_TRUE(slabs_agree(gain, kAlongZ));
  EXPECT_FALSE(slabs_agree(gain, kNowhere));
}

}  // namespace
}  // namespace binderjet
