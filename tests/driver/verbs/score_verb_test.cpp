// SPDX-License-Identifier: GPL-3.0-or-later
// score and simulate, as the command line runs them.
#include <gtest/gtest.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "driver/verbs/verbs.h"
#include "slicer/base/error.h"
#include "slicer/stack/slice_stack.h"
#include "tests/support/models.h"
#include "tests/transport/sample_job.h"

namespace binderjet {
namespace {

namespace fs = std::filesystem;

class ScoreVerb : public testing::Test {
 protected:
  ScoreVerb() {
    // A slab, and a pin on it that is far thinner than the paper's kernel.
    models::write_obj(models::joined(models::box({0, 0, 0}, {6, 6, 1}),
                                     models::box({2.9, 2.95, 0.5}, {3.1, 3.05, 3})),
                      file("pin.obj"));
    run({"slice", file("pin.obj"), "-p", "z450", "-o", file("pin.bjob"), "--enhance", "none"});
  }
  std::string file(const std::string& name) const { return folder_ / name; }
  static nlohmann::json run(std::vector<std::string> words) {
    CLI::App program;
    add_slice_verb(program);
    add_score_verb(program);
    add_explain_verb(program);
    add_simulate_verb(program);
    words.emplace_back("--json");
    words.emplace_back("-q");
    std::reverse(words.begin(), words.end());  // as CLI11 wants them
    testing::internal::CaptureStdout();
    try {
      program.parse(words);
    } catch (...) {
      testing::internal::GetCapturedStdout();
      throw;
    }
    return nlohmann::json::parse(testing::internal::GetCapturedStdout());
  }

  TempFolder folder_;
};

TEST_F(ScoreVerb, TellsOfThePinThatVanishes) {
  const auto score = run({"score", file("pin.bjob"), "--target", file("pin.obj")});
  for (const char* key : {"solid_voxels", "wrong", "floor", "excess", "epe_mm"}) {
    EXPECT_TRUE(score.contains(key)) << key;
  }
  for (const char* key : {"mean", "p95", "max"}) EXPECT_TRUE(score["epe_mm"].contains(key)) << key;
  EXPECT_EQ(score["lost"], 1);
  EXPECT_EQ(score["fused"], 0);
  EXPECT_EQ(score["spurious"], 0);
}

TEST_F(ScoreVerb, TellsHowDeepThePinIsWrongAndWhere) {
  const auto score = run({"score", file("pin.bjob"), "--target", file("pin.obj")});
  // Of a pin of 0.2 x 0.1 mm the middle is 0.05 mm from its surface, less where voxels lie.
  EXPECT_GT(score["depth_mm"]["worst"], 0.02);
  EXPECT_LE(score["depth_mm"]["p999"], score["depth_mm"]["worst"].get<double>() + 5e-4);
  EXPECT_LT(score["depth_mm"]["worst"], 0.15) << "and the slab's corners are no deeper";
  EXPECT_EQ(score["depth_mm"]["searched"], 2);
  const auto& deepest = score["deepest"];
  EXPECT_NEAR(deepest["depth_mm"].get<double>(), score["depth_mm"]["worst"].get<double>(), 1e-4);
  const double layer_mm = 0.102;
  EXPECT_NEAR(deepest["at_mm"][2].get<double>(), (deepest["layer"].get<int>() + 0.5) * layer_mm,
              layer_mm / 2);
}

TEST_F(ScoreVerb, TakesTheModelThatTheJobWasSlicedFromIfNoneIsNamed) {
  EXPECT_EQ(run({"score", file("pin.bjob")}),
            run({"score", file("pin.bjob"), "--target", file("pin.obj")}));
  fs::remove(file("pin.obj"));
  EXPECT_THROW(run({"score", file("pin.bjob")}), Error);
}

TEST_F(ScoreVerb, SaysThatAPrintFarFromItsModelIsMoreThanTwoMillimetersOff) {
  // The model that is named is another one than was sliced: a small cube where a slab is printed.
  models::write_obj(models::box({0, 0, 0}, {0.5, 0.5, 0.5}), file("cube.obj"));
  const auto score = run({"score", file("pin.bjob"), "--target", file("cube.obj")});
  EXPECT_EQ(score["depth_mm"]["worst"], score["depth_mm"]["searched"]);
  EXPECT_EQ(score["deepest"]["kind"], "fused") << "of equals before what is thick";
}

TEST_F(ScoreVerb, ListsItWithItsPlaceAndDrawsIt) {
  run({"score", file("pin.bjob"), "--target", file("pin.obj"), "--map", file("map")});
  std::ifstream text(file("map/features.json"));
  const auto list = nlohmann::json::parse(text);
  EXPECT_EQ(list["lost"], 1);
  const auto pin = list["features"].at(0);
  EXPECT_EQ(pin["kind"], "lost");
  // The part stands in the middle of a bed of 203 x 254 mm, snapped to a pixel.
  EXPECT_NEAR(pin["at_mm"][0].get<double>(), 101.5, 0.1);
  EXPECT_NEAR(pin["at_mm"][1].get<double>(), 127, 0.1);
  // The slab is 10 layers high, the eleventh is worn with it.
  EXPECT_EQ(pin["layers"][0], 11);
  EXPECT_EQ(pin["layers"][1], 30);
  EXPECT_NEAR(pin["size_mm"][0].get<double>(), 0.2, 0.05);
  EXPECT_NEAR(pin["size_mm"][1].get<double>(), 0.1, 0.03);

  const StackReader map(file("map"));
  EXPECT_EQ(map.info().kind, StackKind::kColor);
  EXPECT_EQ(map.info().size[2], 30);
}

TEST_F(ScoreVerb, ScoresAPieceOfAJob) {
  run({"slice", file("pin.obj"), "-p", "z450", "-o", file("piece.bjob"), "--layers", "15:25",
       "--enhance", "none"});
  const auto score =
      run({"score", file("piece.bjob"), "--target", file("pin.obj"), "--map", file("piece_map")});
  EXPECT_EQ(score["lost"], 1);
  std::ifstream text(file("piece_map/features.json"));
  EXPECT_EQ(nlohmann::json::parse(text)["features"].at(0)["layers"],
            nlohmann::json::parse("[15, 25]"));
}

TEST_F(ScoreVerb, PutsPlainPaperAndInverseSideBySide) {
  const auto score = run({"score", file("pin.bjob"), "--target", file("pin.obj"), "--compare"});
  const auto& plain = score["compare"]["none"];
  const auto& inverse = score["compare"]["inverse"];
  EXPECT_EQ(plain["excess"], score["excess"]) << "the job's own masks are plain";
  EXPECT_EQ(plain["window_excess"], score["window_excess"]);
  EXPECT_LT(inverse["excess"], plain["excess"]);
  EXPECT_LT(inverse["excess"], score["compare"]["paper"]["excess"]);
  EXPECT_EQ(plain["lost"], 1);
  EXPECT_EQ(inverse["lost"], 0) << "the pin is printed";
  EXPECT_EQ(inverse["spurious"], 0);
  EXPECT_EQ(plain["loose"], 0);
  EXPECT_GE(inverse["mask"]["least_island_px"], 4) << "the profile's rules";
  EXPECT_TRUE(plain["mask"]["least_hole_px"].is_null());
  EXPECT_LE(inverse["excess"], inverse["window_excess"]["mean"]);
  EXPECT_LE(inverse["window_excess"]["mean"], inverse["window_excess"]["worst"]);
}

TEST_F(ScoreVerb, ExplainsAPixelByItsDose) {
  // Well within the slab: all on, full dose, and without it still enough.
  const auto why = run({"explain", file("pin.bjob"), "30,50,3"});
  EXPECT_EQ(why["on"], true);
  EXPECT_EQ(why["target_share"], 1.0);
  EXPECT_EQ(why["level"], 0.5);
  ASSERT_EQ(why["dose"].size(), 4U);
  EXPECT_NEAR(why["dose"].at(0).get<double>(), 1, 1e-6);
  // A pixel of 2 x 2 voxels is about 4 of the 16.5 x 10.6 that the box spreads it over.
  const double share = 4 / (0.7 / (25.4 / 600) * 0.3 / (25.4 / 900));
  EXPECT_NEAR(why["dose_flipped"].at(0).get<double>(), 1 - share, 1e-6);
  EXPECT_EQ(why["wrong_if_flipped"], 0);
  EXPECT_EQ(why["rules_allow_flip"], false) << "a hole of one pixel";
  EXPECT_THROW(run({"explain", file("pin.bjob"), "30,50,300"}), Error);
}

TEST_F(ScoreVerb, WritesNoMapOverSomebodysWork) {
  fs::create_directories(file("mine"));
  std::ofstream(file("mine/letter.txt")) << "dear";
  EXPECT_THROW(run({"score", file("pin.bjob"), "--target", file("pin.obj"), "--map", file("mine")}),
               Error);
  EXPECT_TRUE(fs::exists(file("mine/letter.txt")));
}

}  // namespace
}  // namespace binderjet
