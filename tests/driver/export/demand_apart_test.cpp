// SPDX-License-Identifier: GPL-3.0-or-later
#include "driver/export/demand_apart.h"

#include <gtest/gtest.h>

#include "slicer/base/error.h"
#include "tests/support/program.h"

namespace binderjet {
namespace {

bool apart(const std::vector<std::string>& outputs, const std::vector<std::string>& inputs = {}) {
  try {
    demand_apart(outputs, inputs);
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kUsage);
    return false;
  }
  return true;
}

TEST(DemandApart, TakesPlacesSideBySide) {
  EXPECT_TRUE(apart({"out/mask", "out/color", "out/page.html"}, {"a.bjob", "out/b.bjob"}));
  EXPECT_TRUE(apart({"out", "output"}, {"out.bjob"}));
}

TEST(DemandApart, RefusesOnePlaceHoweverItIsWritten) {
  EXPECT_FALSE(apart({"a.html", "a.html"}));
  EXPECT_FALSE(apart({"out/", "./out"}));
  EXPECT_FALSE(apart({"out/../a.3mf", "a.3mf"}));
  EXPECT_FALSE(apart({"x/../a.bjob"}, {"a.bjob"}));
}

TEST(DemandApart, RefusesAPlaceInAnother) {
  EXPECT_FALSE(apart({"out", "out/page.html"}));
  EXPECT_FALSE(apart({"out/page.html", "out"}));
  EXPECT_FALSE(apart({"out"}, {"out/a.bjob"}));
}

TEST(DemandApart, TakesAnOutputBesideItsInput) { EXPECT_TRUE(apart({"in/mask"}, {"in/a.bjob"})); }

TEST(DemandApart, FollowsLinks) {
  const Workplace here;
  std::filesystem::create_directory(here / "real");
  std::filesystem::create_directory_symlink(here / "real", here / "link");
  EXPECT_FALSE(apart({here / "link/a.html", here / "real/a.html"}));
  EXPECT_FALSE(apart({here / "link"}, {here / "real/a.bjob"}));
}

}  // namespace
}  // namespace binderjet
