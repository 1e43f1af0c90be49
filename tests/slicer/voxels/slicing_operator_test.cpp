// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/voxels/slicing_operator.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

namespace binderjet {
namespace {

VoxelLayer voxels(int width, int height, int rz, const std::vector<bool>& bits) {
  VoxelLayer layer;
  std::size_t next = 0;
  for (int s = 0; s < rz; ++s) {
    RunLayer slice(width);
    for (int y = 0; y < height; ++y) {
      slice.append_row_where([&](int) { return bits[next++]; });
    }
    layer.slices.push_back(slice);
  }
  return layer;
}

Grid grid_of(int rx, int ry, int rz) { return {{0.1, 0.1, 0.1}, {rx, ry, rz}}; }

TEST(SlicingOperator, TakesExactlyHalfAsSolid) {
  const std::vector<bool> half = {true, true, false, false, false, false, true, true};
  EXPECT_EQ(slicing_operator(voxels(2, 2, 2, half), grid_of(2, 2, 2)).count(), 1);
  const std::vector<bool> less = {true, true, false, false, false, false, false, true};
  EXPECT_EQ(slicing_operator(voxels(2, 2, 2, less), grid_of(2, 2, 2)).count(), 0);
}

TEST(SlicingOperator, NeedsTwoOfThreeAndTwoOfFour) {
  EXPECT_EQ(slicing_operator(voxels(3, 1, 1, {true, false, false}), grid_of(3, 1, 1)).count(), 0);
  EXPECT_EQ(slicing_operator(voxels(3, 1, 1, {true, false, true}), grid_of(3, 1, 1)).count(), 1);
  EXPECT_EQ(slicing_operator(voxels(2, 2, 1, {true, false, false, true}), grid_of(2, 2, 1)).count(),
            1);
}

RC_GTEST_PROP(SlicingOperatorProperty, CountsTheVoxelsOfEachPixel, ()) {
  const int rx = *rc::gen::inRange(1, 4);
  const int ry = *rc::gen::inRange(1, 4);
  const int rz = *rc::gen::inRange(1, 4);
  const int nx = *rc::gen::inRange(1, 6);
  const int ny = *rc::gen::inRange(1, 4);
  const auto size = static_cast<std::size_t>(nx * rx * ny * ry * rz);
  const auto bits = *rc::gen::container<std::vector<bool>>(size, rc::gen::arbitrary<bool>());
  const VoxelLayer layer = voxels(nx * rx, ny * ry, rz, bits);
  const RunLayer mask = slicing_operator(layer, grid_of(rx, ry, rz));
  RC_ASSERT(mask.width() == nx);
  RC_ASSERT(mask.height() == ny);
  for (int j = 0; j < ny; ++j) {
    for (int i = 0; i < nx; ++i) {
      int ones = 0;
      for (const RunLayer& slice : layer.slices) {
        for (int y = j * ry; y < (j + 1) * ry; ++y) {
          for (int x = i * rx; x < (i + 1) * rx; ++x) ones += slice.at(x, y) ? 1 : 0;
        }
      }
      RC_ASSERT(mask.at(i, j) == (2 * ones >= rx * ry * rz));
    }
  }
}

}  // namespace
}  // namespace binderjet
