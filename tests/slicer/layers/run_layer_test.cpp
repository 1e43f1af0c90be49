// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/layers/run_layer.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

namespace binderjet {
namespace {

RunLayer layer_of(const std::vector<std::string>& rows) {
  RunLayer layer(static_cast<int>(rows.front().size()));
  for (const std::string& row : rows) {
    layer.append_row_where([&](int x) { return row[static_cast<std::size_t>(x)] == '#'; });
  }
  return layer;
}

TEST(RunLayer, ReadsBackWhatWasDrawn) {
  const RunLayer layer = layer_of({"..##.#", "......", "######"});
  EXPECT_EQ(layer.height(), 3);
  EXPECT_EQ(std::vector<int>(layer.row(0).begin(), layer.row(0).end()),
            (std::vector<int>{2, 4, 5, 6}));
  EXPECT_TRUE(layer.at(3, 0));
  EXPECT_FALSE(layer.at(4, 0));
  EXPECT_EQ(layer.count(), 9);
}

TEST(RunLayer, ReadsAsPowderOutside) {
  const RunLayer layer = layer_of({"##"});
  EXPECT_FALSE(layer.at(2, 0));
  EXPECT_FALSE(layer.at(0, 1));
  EXPECT_FALSE(layer.at(0, -1));
  EXPECT_FALSE(layer.at(-1, 0));
}

TEST(RunLayer, JoinsRunsThatTouchAndDropsEmptyOnes) {
  RunLayer layer(9);
  for (const int x : {1, 3, 3, 5, 7, 7}) layer.flip(x);
  layer.end_row();
  EXPECT_EQ(layer, layer_of({".####...."}));
}

TEST(RunLayer, PacksTheFirstVoxelIntoTheHighestBit) {
  const std::vector<std::byte> bits = pack(layer_of({"#.......#.", ".########."}));
  EXPECT_EQ(bits, (std::vector<std::byte>{std::byte{0x80}, std::byte{0x80}, std::byte{0x7f},
                                          std::byte{0x80}}));
}

RC_GTEST_PROP(RunLayerProperty, UnpacksWhatItPacked, ()) {
  const int width = *rc::gen::inRange(1, 300);
  const int height = *rc::gen::inRange(1, 5);
  std::vector<std::string> rows;
  for (int y = 0; y < height; ++y) {
    // Long runs and single voxels both occur.
    std::string row;
    while (static_cast<int>(row.size()) < width) {
      row.append(*rc::gen::element<std::size_t>(1, 1, 2, 7, 8, 64, 65, 130),
                 *rc::gen::arbitrary<bool>() ? '#' : '.');
    }
    row.resize(static_cast<std::size_t>(width));
    rows.push_back(row);
  }
  const RunLayer layer = layer_of(rows);
  RC_ASSERT(unpack(pack(layer), width, height) == layer);
}

TEST(RunLayer, WindowCutsAndPads) {
  const RunLayer layer = layer_of({"##..##", "######"});
  EXPECT_EQ(window(layer, 1, 0, 4, 3), layer_of({"#..#", "####", "...."}));
  EXPECT_EQ(window(layer, -2, -1, 10, 2), layer_of({"..........", "..##..##.."}));
}

}  // namespace
}  // namespace binderjet
