// SPDX-License-Identifier: GPL-3.0-or-later
// What is printed where no part is.
#include "slicer/enhance/inverse/spurious.h"

#include <gtest/gtest.h>

#include "tests/support/rows.h"

namespace binderjet {
namespace {

TEST(Spurious, IsWhatTouchesNoSliceOfTheTarget) {
  const VoxelLayer target{{rows_of(20, {{2, 5}, {}, {}}), rows_of(20, {{}, {10, 12}, {}})}};
  // One region on each slice's part, wider than it, and one on nothing.
  const RunLayer printed = rows_of(20, {{1, 6}, {9, 13, 16, 18}, {16, 18}});
  EXPECT_EQ(spurious_print(target, printed), rows_of(20, {{}, {16, 18}, {16, 18}}));
}

TEST(Spurious, IsNothingWhereThePrintIsTheTarget) {
  const RunLayer part = rows_of(20, {{2, 5}, {2, 8}, {}});
  EXPECT_EQ(spurious_print({{part, part}}, part), RunLayer::powder(20, 3));
}

}  // namespace
}  // namespace binderjet
