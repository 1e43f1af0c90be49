// SPDX-License-Identifier: GPL-3.0-or-later
// A profile is taken whole or refused with the place of its mistake.
#include "driver/profile/profile.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "slicer/base/error.h"

namespace binderjet {
namespace {

constexpr const char* kProfile = R"(name = "A"
source = "this test"
[grid]
dpi = [300, 450]
layer_mm = [0.102, 0.089]
detail_vx = [2, 2, 2]
[bed]
size_mm = [203, 254, 204]
[[effects]]
kind = "spread"
shape = "box"
width_mm = [0.7, 0.3]
[[effects]]
kind = "threshold"
level = 0.5
[speed]
layers_per_minute = [2, 4]
dry_minutes = 90
[device]
protocol = "binderjet-1"
usb = []
[mask]
min_hole_px = 4
)";

// A line of the profile, what stands in its place, and what is said of that.
struct Slip {
  const char* line;
  const char* by;
  const char* said;
};

void PrintTo(const Slip& slip, std::ostream* out) { *out << slip.by; }

class ProfileSlip : public testing::TestWithParam<Slip> {};

TEST_P(ProfileSlip, IsRefusedWithItsPlace) {
  std::string text = kProfile;
  const std::size_t at = text.find(GetParam().line);
  ASSERT_NE(at, std::string::npos);
  text.replace(at, text.find('\n', at) - at, GetParam().by);
  try {
    parse_profile(text, "a.toml");
    FAIL() << "was taken";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kBadInput);
    EXPECT_THAT(error.what(), testing::StartsWith(GetParam().said));
  }
}

INSTANTIATE_TEST_SUITE_P(
    Profile, ProfileSlip,
    testing::Values(
        Slip{"name = ", "name = 450", "a.toml:1:8: name must be a text"},
        Slip{"dpi = ", "dpi = [300, 0]", "a.toml:4:7: dpi: 0 is not above 0.5"},
        Slip{"dpi = ", "dpi = [300]", "a.toml:4:7: dpi needs 2 numbers"},
        Slip{"dpi = ", "dpi = [\"fine\", 1]", "a.toml:4:8: dpi must be a number"},
        Slip{"dpi = ", "dpi = [300, 450", "a.toml:5:"},
        Slip{"layer_mm = ", "layer_mm = []", "a.toml:5:12: layer_mm must not be empty"},
        Slip{"detail_vx = ", "detail_vx = [2, 2, 2.5]", "a.toml:6:13: detail_vx must be whole"},
        Slip{"detail_vx = ", "detail_vx = [2, 2, 17]", "a.toml:6:13: detail_vx: 17 is not above 0"},
        Slip{"shape = ", "shape = \"star\"", "a.toml:11:9: shape: \"star\" is not one of: box"},
        Slip{"width_mm = ", "width_mm = [0.7, -0.3]", "a.toml:12:12: width_mm: -0.3 is not above"},
        Slip{"level = ", "level = 0.5\nlevels = 1", "a.toml:16:10: levels: unknown key"},
        Slip{"dry_minutes = ", "dry_minute = 90", "a.toml:16:1: [speed] needs the key dry_minutes"},
        Slip{"usb = ", "usb = \"1234:5678\"", "a.toml:21:7: usb must be a list"},
        Slip{"usb = ", "usb = [7]", "a.toml:21:8: usb must be a list"},
        Slip{"usb = ", "usb = [\"12:zz\"]", "a.toml:21:8: usb needs \"vid:pid\" in hexadecimal"},
        Slip{"[mask]", "[mask]\nmin_hole = 4", "a.toml:23:1: unknown key min_hole in [mask]"},
        Slip{"min_hole_px = ", "min_hole_px = 1.5", "a.toml:23:15: min_hole_px must be a whole"},
        Slip{"min_hole_px = ", "[strength]\nthinnest = 2",
             "a.toml:24:1: unknown key thinnest in [strength]"},
        Slip{"[mask]", "[strength]\nthinnest_mm = 0",
             "a.toml:23:15: thinnest_mm: 0 is not above 0"},
        Slip{"[mask]", "[strength]\nnarrowest_mm = 21", "a.toml:23:16: narrowest_mm: 21 is not"},
        Slip{"[mask]", "[masks]", "a.toml:22:2: unknown key masks in the profile"}));

TEST(Profile, EveryOneThatIsInstalledIsTaken) {
  int count = 0;
  for (const auto& file : std::filesystem::directory_iterator(BINDERJET_SOURCE_DIR "/profiles")) {
    EXPECT_NO_THROW(load_profile(file.path().string())) << file.path();
    ++count;
  }
  EXPECT_GT(count, 0);
}

TEST(Profile, HasNoRulesOfStrengthUnlessItNamesThem) {
  EXPECT_FALSE(parse_profile(kProfile, "a.toml").strength.thinnest_mm);
  const StrengthRules named =
      parse_profile(std::string(kProfile) + "[strength]\nthinnest_mm = 2\n", "a.toml").strength;
  EXPECT_EQ(named.thinnest_mm, 2);
  EXPECT_FALSE(named.narrowest_mm);
}

TEST(Profile, GivesTheGridOfALayerThatItHasAndNamesThoseOtherwise) {
  const Profile profile = parse_profile(kProfile, "a.toml");
  const Grid grid = profile.grid(0.089);
  EXPECT_DOUBLE_EQ(grid.pitch_mm[0], 25.4 / 300);
  EXPECT_DOUBLE_EQ(grid.pitch_mm[1], 25.4 / 450);
  EXPECT_DOUBLE_EQ(grid.pitch_mm[2], 0.089);
  EXPECT_DOUBLE_EQ(profile.grid(std::nullopt).pitch_mm[2], 0.102) << "the first";
  try {
    profile.grid(0.1);
    FAIL() << "was taken";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kUsage);
    EXPECT_THAT(error.what(), testing::HasSubstr("0.102 or 0.089 mm, not 0.1"));
  }
}

}  // namespace
}  // namespace binderjet
