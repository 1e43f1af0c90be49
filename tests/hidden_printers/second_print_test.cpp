// SPDX-License-Identifier: GPL-3.0-or-later
// The loop of calibration ends in a better part: small and one printer; all of them, and the masks
// as a table: binderjet_loop_trials.
#include "tests/hidden_printers/second_print.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "slicer/coupon/coupon.h"

namespace binderjet {
namespace {

TEST(SecondPrint, IsNearestToTheModelWithInverseMasks) {
  const auto printers = hidden::catalogue(1);
  const auto printer = std::find_if(printers.begin(), printers.end(),
                                    [](const auto& p) { return p.name == "layer_shift_low"; });
  const hidden::Wanted part = hidden::scaled(coupon(CouponKind::kFull), 0.3);
  const hidden::Loop loop = hidden::close_loop(*printer, part, part, hidden::declared(), {4, 4});
  const auto excess = [&](const std::string& enhance) {
    return loop.second.at(enhance).voxels.excess();
  };
  std::printf("excess of the second print: none %.4f, paper %.4f, inverse %.4f\n", excess("none"),
              excess("paper"), excess("inverse"));
  EXPECT_LT(excess("inverse"), 0.5 * excess("none"));
  EXPECT_LT(excess("inverse"), 0.5 * excess("paper"));
}

}  // namespace
}  // namespace binderjet
