// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/model/dose/kernel.h"

#include <gtest/gtest.h>

#include <cmath>

namespace binderjet {
namespace {

TEST(Kernel, IsABoxAgainIfItWasOne) {
  for (const double width : {0.4, 1.0, 5.0, 16.0, 16.5354}) {
    const BoxWeights box = box_weights(width);
    const auto back = as_box(box_kernel(box));
    ASSERT_TRUE(back.has_value()) << width;
    EXPECT_EQ(back->reach, box.reach);
    EXPECT_EQ(back->end, box.end);
    EXPECT_EQ(back->total(), box.total());
  }
}

TEST(Kernel, IsNoBoxIfItIsLopsidedOrPeaked) {
  EXPECT_FALSE(as_box(Kernel{0, {1, 1}}).has_value());
  EXPECT_FALSE(as_box(Kernel{-2, {1, 2, 3, 2, 1}}).has_value());
  EXPECT_FALSE(as_box(gaussian_kernel(8)).has_value());
}

TEST(GaussianKernel, HasHalfItsHeightAtHalfItsWidth) {
  const Kernel kernel = gaussian_kernel(40);
  EXPECT_EQ(kernel.first, -kernel.last());
  const auto height = static_cast<double>(kernel.at(0));
  // The weights are integrals over a voxel, of which the width has 40.
  EXPECT_NEAR(static_cast<double>(kernel.at(20)) / height, 0.5, 0.001);
  EXPECT_EQ(kernel.at(20), kernel.at(-20));
}

TEST(GaussianKernel, LeavesOutNoMoreThanItSays) {
  for (const double width : {0.1, 0.7, 3.0, 16.5, 120.0}) {
    const Kernel kernel = gaussian_kernel(width);
    const double lost = 1 - static_cast<double>(kernel.total()) / (1 << 20);
    // The cut, and half a unit of rounding for each weight.
    EXPECT_LE(lost, 1.0 / (1 << 12) + 0.5 * static_cast<double>(kernel.weights.size()) / (1 << 20));
    EXPECT_GE(lost, -0.5 * static_cast<double>(kernel.weights.size()) / (1 << 20));
  }
  EXPECT_EQ(gaussian_kernel(0.1).weights.size(), 1U) << "far below a voxel nothing spreads";
}

}  // namespace
}  // namespace binderjet
