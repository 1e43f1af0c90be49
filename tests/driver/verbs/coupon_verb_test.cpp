// SPDX-License-Identifier: GPL-3.0-or-later
// Coupons are parts that every printer takes without a remark.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "slicer/coupon/coupon.h"
#include "tests/support/program.h"

namespace binderjet {
namespace {

using testing::HasSubstr;
using testing::Not;

std::vector<std::string> profiles(const Workplace& here) {
  const Ran ran = here.run({"profile", "list", "--json"});
  EXPECT_EQ(ran.status, 0) << ran.err;
  std::vector<std::string> names;
  const nlohmann::json json = ran.json();
  for (const auto& profile : json["profiles"]) names.push_back(profile["name"]);
  return names;
}

class CouponOfKind : public testing::TestWithParam<std::string> {};

TEST_P(CouponOfKind, SlicesWithoutAWarningForEveryProfile) {
  const Workplace here;
  const std::vector<std::string> printers = profiles(here);
  EXPECT_GE(printers.size(), 2U);
  const std::string part = here / "part.stl";
  ASSERT_EQ(here.run({"coupon", "--kind", GetParam(), "-o", part}).status, 0);
  for (const std::string& printer : printers) {
    // What is said of the model is said of all of it, and of masks these layers are like the rest.
    const Ran ran =
        here.run({"slice", part, "-p", printer, "--layers", "16:22", "-o", here / "a.bjob"});
    EXPECT_EQ(ran.status, 0) << ran.err;
    EXPECT_THAT(ran.err, Not(HasSubstr("warning"))) << "on " << printer;
  }
}

INSTANTIATE_TEST_SUITE_P(Kinds, CouponOfKind, testing::ValuesIn(coupon_kinds()),
                         [](const auto& kind) { return kind.param; });

}  // namespace
}  // namespace binderjet
