// SPDX-License-Identifier: GPL-3.0-or-later
// profile list, show and check, as a person runs them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "tests/support/program.h"

namespace binderjet {
namespace {

using testing::HasSubstr;

TEST(ProfileVerb, ListsWhatSliceKnowsByName) {
  const Workplace here;
  const Ran ran = here.run({"profile", "list", "--json"});
  ASSERT_EQ(ran.status, 0) << ran.err;
  std::vector<std::string> names;
  const auto json = ran.json();
  for (const auto& profile : json["profiles"]) {
    names.push_back(profile["name"]);
    EXPECT_EQ(here.run({"profile", "check", names.back()}).status, 0);
    EXPECT_EQ(here.run({"profile", "check", profile["path"]}).status, 0);
  }
  EXPECT_THAT(names, testing::IsSupersetOf({"z450", "z450-fig3"}));
  const Ran told = here.run({"profile", "list"});
  EXPECT_THAT(told.out, HasSubstr("z450             300 x 450 dpi, bed 203 x 254 x 204 mm"));
}

TEST(ProfileVerb, ShowsTheFileAsItStandsOrItsNumbers) {
  const Workplace here;
  const std::string text = here.run({"profile", "show", "z450"}).out;
  EXPECT_THAT(text, HasSubstr("# section 5:")) << "where a number comes from";
  std::ofstream(here / "own.toml") << text;
  EXPECT_EQ(here.run({"profile", "show", here / "own.toml"}).out, text);
  const auto json = here.run({"profile", "show", "z450", "--json"}).json();
  EXPECT_EQ(json["dpi"], (std::vector<double>{300, 450}));
  EXPECT_EQ(json["effects"][0]["kind"], "spread");
}

TEST(ProfileVerb, ChecksAndSaysWhereTheFaultIs) {
  const Workplace here;
  std::ofstream(here / "own.toml")
      << here.run({"profile", "show", "z450"}).out << "[nozzle]\nsize_mm = 1\n";
  const Ran ran = here.run({"profile", "check", here / "own.toml"});
  EXPECT_EQ(ran.status, 3);
  EXPECT_THAT(ran.err, HasSubstr("own.toml:"));
  EXPECT_THAT(ran.err, HasSubstr("nozzle"));
  EXPECT_EQ(here.run({"profile", "show", "no-such-printer"}).status, 3);
}

}  // namespace
}  // namespace binderjet
