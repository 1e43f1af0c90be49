// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/model/dose/box_filter.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

namespace binderjet {
namespace {

RunLayer layer_of(int width, int height, const std::vector<bool>& bits) {
  RunLayer layer(width);
  std::size_t next = 0;
  for (int y = 0; y < height; ++y) {
    layer.append_row_where([&](int) { return bits[next++]; });
  }
  return layer;
}

TEST(BoxWeights, CenterAnEvenBoxWithHalfWeightsAtItsEnds) {
  const BoxWeights weights = box_weights(16);
  EXPECT_EQ(weights.reach, 8);
  EXPECT_EQ(weights.end * 2, weights.full);
  EXPECT_EQ(weights.total(), 16 * weights.full);
}

TEST(BoxWeights, GiveAnOddBoxWholeWeights) {
  const BoxWeights weights = box_weights(5);
  EXPECT_EQ(weights.reach, 2);
  EXPECT_EQ(weights.end, weights.full);
  EXPECT_EQ(weights.total(), 5 * weights.full);
}

TEST(BoxWeights, KeepAVoxelAloneBelowOneVoxel) {
  EXPECT_EQ(box_weights(0.3).reach, 0);
  EXPECT_EQ(box_weights(1).reach, 0);
}

TEST(BoxThreshold, MovesNoStraightEdgeAtHalf) {
  RunLayer mask(20);
  for (int y = 0; y < 20; ++y) {
    mask.flip(5);
    mask.flip(15);
    mask.end_row();
  }
  const BoxWeights box = box_weights(6.4);
  const RunLayer printed = box_threshold(mask, {1, 1}, box, box, min_sum(box, box, 0.5));
  const std::span<const int> middle = printed.row(10);
  EXPECT_EQ(std::vector<int>(middle.begin(), middle.end()), (std::vector<int>{5, 15}));
}

RC_GTEST_PROP(BoxThresholdProperty, EqualsTheSumOverEveryVoxel, ()) {
  const int nx = *rc::gen::inRange(1, 20);
  const int ny = *rc::gen::inRange(1, 8);
  const int rx = *rc::gen::inRange(1, 4);
  const int ry = *rc::gen::inRange(1, 4);
  const auto bits = *rc::gen::container<std::vector<bool>>(static_cast<std::size_t>(nx * ny),
                                                           rc::gen::arbitrary<bool>());
  const BoxWeights x = box_weights(*rc::gen::inRange(1, 140) / 10.0);
  const BoxWeights y = box_weights(*rc::gen::inRange(1, 90) / 10.0);
  const std::int64_t least = min_sum(x, y, *rc::gen::inRange(1, 101) / 100.0);
  const RunLayer mask = layer_of(nx, ny, bits);
  const RunLayer out = box_threshold(mask, {rx, ry}, x, y, least);
  RC_ASSERT(out.width() == nx * rx);
  RC_ASSERT(out.height() == ny * ry);
  for (int j = 0; j < ny * ry; ++j) {
    for (int i = 0; i < nx * rx; ++i) {
      std::int64_t sum = 0;
      for (int dy = -y.reach; dy <= y.reach; ++dy) {
        for (int dx = -x.reach; dx <= x.reach; ++dx) {
          if (i + dx < 0 || j + dy < 0) continue;
          if (mask.at((i + dx) / rx, (j + dy) / ry)) sum += x.at(dx) * y.at(dy);
        }
      }
      RC_ASSERT(out.at(i, j) == (sum >= least));
    }
  }
}

}  // namespace
}  // namespace binderjet
