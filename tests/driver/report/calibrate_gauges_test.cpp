// SPDX-License-Identifier: GPL-3.0-or-later
// calibrate --gauges, as a person runs it: a table in, a verdict, a profile and a page out.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <map>

#include "driver/profile/profile.h"
#include "driver/profile/write_profile.h"
#include "slicer/base/error.h"
#include "tests/support/caliper_readings.h"
#include "tests/support/markup.h"
#include "tests/support/program.h"

namespace binderjet {
namespace {

using testing::HasSubstr;

class CalibrateGauges : public testing::Test {
 protected:
  std::string write(const std::string& text) {
    std::ofstream(here_ / "g.csv") << text;
    return here_ / "g.csv";
  }
  Ran calibrate(const std::string& csv) const {
    return here_.run({"calibrate", "-p", "z450", "--gauges", csv, "-o", here_ / "out", "--json"});
  }
  Workplace here_;
};

constexpr const char* kFigure3 =
    "# seen on one print\naxis,first_visible_slot_mm_low,first_visible_slot_mm_high\n"
    "x,0.6,0.7\ny,0.3,0.3\nz,0.1,0.1\n";

TEST_F(CalibrateGauges, WriteTheProfileTheVerdictAndThePage) {
  const Ran ran = calibrate(write(kFigure3));
  ASSERT_EQ(ran.status, 0) << ran.err;
  const auto json = ran.json();
  EXPECT_EQ(json, nlohmann::json::parse(here_.text("out/calibration.json")));
  EXPECT_EQ(json["verdict"], "effect");
  EXPECT_EQ(json["effects"][0]["kind"], "threshold");
  EXPECT_EQ(json["effects"][0]["rivals"][0]["kind"], "kernel_x");
  EXPECT_NEAR(json["readings"][0]["residual_mm"], 0.2, 0.05);
  EXPECT_LT(json["after"]["rms_mm"], json["before"]["rms_mm"]);
  EXPECT_EQ(markup_fault(here_.text("out/report.html")), "");
  EXPECT_EQ(here_.run({"profile", "check", here_ / "out/z450.calibrated.toml"}).status, 0);
  const Profile made = load_profile(here_ / "out/z450.calibrated.toml");
  const Profile kept = load_profile("z450-fig3");
  ASSERT_EQ(made.effects.size(), kept.effects.size());
  for (std::size_t i = 0; i < made.effects.size(); ++i) {
    EXPECT_EQ(made.effects[i].numbers, kept.effects[i].numbers)
        << "profiles/z450-fig3.toml is this";
  }
}

TEST_F(CalibrateGauges, TakeCaliperReadingsToo) {
  MeasuredBlocks blocks;
  blocks.slip_y_mm = 0.2;
  blocks.column_mm = 0.15;
  write_readings(here_ / "lengths.csv", blocks, 1);
  const Ran ran = calibrate(here_ / "lengths.csv");
  ASSERT_EQ(ran.status, 0) << ran.err;
  const auto json = ran.json();
  EXPECT_EQ(json, nlohmann::json::parse(here_.text("out/calibration.json")));
  EXPECT_EQ(json["verdict"], "effect");
  EXPECT_EQ(json["rows"], 96);
  std::map<std::string, nlohmann::json> effects;
  for (const auto& effect : json["effects"]) effects[effect["kind"]] = effect;
  ASSERT_THAT(effects, testing::SizeIs(3));
  EXPECT_THAT(effects, testing::Contains(testing::Key("threshold")));
  EXPECT_EQ(effects["layer_shift_low"]["covariate"]["axis"], "layer");
  EXPECT_EQ(effects["grad_bed"]["covariate"]["axis"], "position");
  EXPECT_LT(effects["grad_bed"]["p"], 0.05);
  EXPECT_LT(json["after"]["rms_mm"], 0.2 * json["before"]["rms_mm"].get<double>());
  const std::string page = here_.text("out/report.html");
  EXPECT_EQ(markup_fault(page), "");
  EXPECT_THAT(page, HasSubstr("Growth per batch (offset), layer shift (along y), place on the bed "
                              "(4 parts to a column) bring that to"));
  EXPECT_THAT(page, HasSubstr("by reading, y")) << "where the shift is seen";

  const Ran told = here_.run(
      {"calibrate", "-p", "z450", "--gauges", here_ / "lengths.csv", "-o", here_ / "told"});
  EXPECT_THAT(told.out, HasSubstr("growth is an offset rather than a scale in 4 of 4 batches"));
}

TEST_F(CalibrateGauges, NeedATableThatTheyKnow) {
  const Ran unknown = calibrate(write("a,b\n1,2\n"));
  EXPECT_EQ(unknown.status, 3);
  EXPECT_THAT(unknown.err, HasSubstr("g.csv:1: has neither"));
  EXPECT_EQ(
      calibrate(write("axis,first_visible_slot_mm_low,first_visible_slot_mm_high\nx,a,1\n")).status,
      3);
  EXPECT_FALSE(std::filesystem::exists(here_ / "out/calibration.json"));
  EXPECT_EQ(here_.run({"calibrate", "-p", "z450", "-o", here_ / "out"}).status, 2);
}

TEST(WriteProfile, KeepsAllButNameSourceAndEffects) {
  const Profile declared = load_profile("z450");
  std::vector<EffectSpec> effects = declared.effects;
  effects[1].numbers["level"] = {1.0 / 3};
  const std::vector<std::string> notes = {"a note\nof two lines"};
  const std::string text = calibrated_profile(declared, "a \"b\"", "c\\d", notes, effects);
  EXPECT_THAT(text, HasSubstr("# a note of two lines\n[[effects]]"));
  EXPECT_THAT(text, HasSubstr("usb = []                    # the vendor's ids are not public"));
  const Profile read = parse_profile(text, "test");
  EXPECT_EQ(read.name, "a \"b\"");
  EXPECT_EQ(read.source, "c\\d");
  EXPECT_EQ(read.effects[1].numbers.at("level").front(), 1.0 / 3) << "to the last bit";
  EXPECT_EQ(read.bed_mm, declared.bed_mm);
}

TEST(WriteProfile, RefusesEffectsThatItCannotReplace) {
  Profile declared = load_profile("z450");
  const std::vector<EffectSpec> effects = declared.effects;
  const std::size_t first = declared.text.find("[[effects]]");
  const std::size_t after = declared.text.find("[speed]");
  declared.text = "effects = [{kind = \"threshold\", level = 0.5}]\n" +
                  declared.text.substr(0, first) + declared.text.substr(after);
  EXPECT_THROW(calibrated_profile(declared, "n", "s", {}, effects), Error);
}

}  // namespace
}  // namespace binderjet
