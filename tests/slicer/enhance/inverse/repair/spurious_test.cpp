// SPDX-License-Identifier: GPL-3.0-or-later
// What is printed where no part is.
#include "slicer/enhance/inverse/repair/spurious.h"

#include <gtest/gtest.h>

namespace binderjet {
namespace {

RunLayer rows_of(std::initializer_list<std::vector<int>> rows) {
  RunLayer layer(20);
  for (const std::vector<int>& row : rows) layer.append_row(row);
  return layer;
}

TEST(Spurious, IsWhatTouchesNoSliceOfTheTarget) {
  const VoxelLayer target{{rows_of({{2, 5}, {}, {}}), rows_of({{}, {10, 12}, {}})}};
  // One region on each slice's part, wider than it, and one on nothing.
  const RunLayer printed = rows_of({{1, 6}, {9, 13, 16, 18}, {16, 18}});
  EXPECT_EQ(spurious_print(target, printed), rows_of({{}, {16, 18}, {16, 18}}));
}

TEST(Spurious, IsNothingWhereThePrintIsTheTarget) {
  const RunLayer part = rows_of({{2, 5}, {2, 8}, {}});
  EXPECT_EQ(spurious_print({{part, part}}, part), RunLayer::powder(20, 3));
}

}  // namespace
}  // namespace binderjet
