// SPDX-License-Identifier: GPL-3.0-or-later
// Layers as blocks and back.
#include "slicer/layers/blocks.h"

#include <gtest/gtest.h>

#include <memory>
#include <vector>

#include "tests/support/random.h"

namespace binderjet {
namespace {

using whole::Random;

// Layer k is the number k.
class Numbers : public Stream<int> {
 public:
  explicit Numbers(LayerRange range) : rest_(range) {}
  LayerRange rest() const override { return rest_; }
  std::vector<Shared<int>> next(int count) override {
    std::vector<Shared<int>> out;
    for (; count > 0 && rest_.size() > 0; --count) {
      out.push_back(std::make_shared<const int>(rest_.first++));
    }
    return out;
  }

 private:
  LayerRange rest_;
};

TEST(Blocks, HoldTheLayersFromTheirOwnPlacesInTheJob) {
  const BlockForm form{4, 2};
  EXPECT_EQ(form.blocks_of({1, 3}).first, 0);
  EXPECT_EQ(form.blocks_of({1, 3}).last, 2);
  ToBlocks<int> blocks(std::make_unique<Numbers>(form.layers_of({0, 3}, 9)), form, 9);
  const auto all = blocks.next(9);
  ASSERT_EQ(all.size(), 3U);
  EXPECT_EQ(all[0]->size(), 2U);  // cut by the bed
  EXPECT_EQ(*all[1]->front(), 2);
  EXPECT_EQ(all[2]->size(), 3U);  // cut by the job's end
  EXPECT_EQ(*all[2]->back(), 8);
}

TEST(Blocks, GiveBackTheLayersOfAnyRange) {
  Random random;
  for (int round = 0; round < 500; ++round) {
    SCOPED_TRACE(round);
    const int size = random.number(1, 7);
    const BlockForm form{size, random.number(0, size - 1)};
    const int job = random.number(1, 40);
    const int first = random.number(0, job - 1);
    const LayerRange layers{first, random.number(first + 1, job)};
    const LayerRange held = form.layers_of(form.blocks_of(layers), job);
    ASSERT_LE(held.first, layers.first);
    ASSERT_GE(held.last, layers.last);
    FromBlocks<int> back(
        std::make_unique<ToBlocks<int>>(std::make_unique<Numbers>(held), form, job), form, layers,
        job);
    for (int k = layers.first; k < layers.last;) {
      for (const Shared<int>& layer : back.next(random.number(1, 9))) ASSERT_EQ(*layer, k++);
    }
    ASSERT_EQ(back.rest().size(), 0);
  }
}

}  // namespace
}  // namespace binderjet
