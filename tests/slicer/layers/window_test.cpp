// SPDX-License-Identifier: GPL-3.0-or-later
// Layers by their offset from the middle one.
#include "slicer/layers/window.h"

#include <gtest/gtest.h>

#include <memory>
#include <vector>

namespace binderjet {
namespace {

const std::vector<RunLayer> kLayers{RunLayer(1), RunLayer(2), RunLayer(3)};

TEST(Window, CountsOffsetsFromTheMiddleOne) {
  std::vector<Shared<int>> layers{nullptr};
  for (const int k : {0, 1, 2}) layers.push_back(std::make_shared<const int>(k));
  const Window<int> window(layers, {1, 2});
  EXPECT_EQ(window.at(-1), nullptr);
  EXPECT_EQ(window.middle(), 0);
  EXPECT_EQ(*window.at(2), 2);
}

TEST(RunWindow, IsNullBeyondTheLayersThatAreThere) {
  const RunWindow window = runs_around(kLayers, 0, 2);
  EXPECT_EQ(window.reach(), 2);
  EXPECT_EQ(window.at(-1), nullptr);
  EXPECT_EQ(window.middle().width(), 1);
  EXPECT_EQ(window.at(2)->width(), 3);
}

TEST(RunWindow, GivesTheWindowAroundAnotherOfItsLayers) {
  const RunWindow part = runs_around(kLayers, 1, 2).part(1, 1);
  EXPECT_EQ(part.at(-1)->width(), 2);
  EXPECT_EQ(part.middle().width(), 3);
  EXPECT_EQ(part.at(1), nullptr);
}

#ifndef NDEBUG
TEST(WindowDeathTest, StopsWhereAStepLooksFartherThanItSaid) {
  const RunWindow window = runs_around(kLayers, 1, 1);
  EXPECT_DEATH(window.at(2), "offset");
  const std::vector<Shared<int>> one{std::make_shared<const int>(5)};
  EXPECT_DEATH(Window<int>(one).at(-1), "offset");
}
#endif

}  // namespace
}  // namespace binderjet
