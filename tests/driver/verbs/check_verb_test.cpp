// SPDX-License-Identifier: GPL-3.0-or-later
// check finds, in a part made for it, what the printer will do to it, and where.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "tests/support/models.h"
#include "tests/support/program.h"

namespace binderjet {
namespace {

using models::box;
using testing::HasSubstr;

class CheckVerb : public testing::Test {
 protected:
  nlohmann::json check(const Mesh& mesh, const std::string& enhance = "none") const {
    models::write_obj(mesh, here_ / "part.obj");
    const Ran ran = here_.run({"check", here_ / "part.obj", "-p", "z450", "--at", "50,50",
                               "--enhance", enhance, "--json"});
    EXPECT_EQ(ran.status, 0) << ran.err;
    return ran.json();
  }
  // The one thing of a kind that was found.
  static nlohmann::json only(const nlohmann::json& said, const std::string& kind) {
    std::vector<nlohmann::json> all;
    for (const auto& found : said["found"]) {
      if (found["kind"] == kind) all.push_back(found);
    }
    EXPECT_EQ(all.size(), 1) << kind;
    return all.empty() ? nlohmann::json() : all.front();
  }
  Workplace here_;
};

// A block of 10 x 10 x 4 mm with a fin on it, a slot in it and a hollow in it, as asked.
Mesh block(double fin_mm, double slot_mm, bool hollow) {
  Mesh mesh = box({0, 0, 0}, {10, 10, 4});
  if (fin_mm > 0) mesh = models::joined(mesh, box({2, 2, 4}, {2 + fin_mm, 8, 7}));
  if (slot_mm > 0) {
    mesh = models::joined(mesh, box({-4 - slot_mm, 0, 0}, {-slot_mm, 10, 4}));
  }
  if (hollow) mesh = models::joined(mesh, models::inside_out(box({3, 3, 1}, {7, 7, 3})));
  return mesh;
}

TEST_F(CheckVerb, HasNothingToSayOfASolidBlock) {
  const nlohmann::json said = check(block(0, 0, false));
  EXPECT_EQ(said["verdict"], "prints as it is");
  EXPECT_TRUE(said["found"].empty());
  EXPECT_TRUE(said["worst_places"].empty()) << "its corners are round by less than a pixel";
  EXPECT_NEAR(said["powder_ml"].get<double>(), 0.4, 0.01);
  EXPECT_NEAR(said["binder_ml"].get<double>(), 0.4 * 0.36, 0.01);
  EXPECT_NEAR(said["print_minutes"].get<double>(), 90 + 40 / 3.0, 1);  // 40 layers, 3 a minute
}

TEST_F(CheckVerb, NamesAFinThatIsLostWithItsPlaceAndSize) {
  const nlohmann::json said = check(block(0.2, 0, false));
  EXPECT_EQ(said["lost"], 1);
  EXPECT_EQ(said["verdict"], "loses detail");
  const auto& fin = said["found"][0];
  EXPECT_EQ(fin["kind"], "lost");
  EXPECT_NEAR(fin["at_mm"][0].get<double>(), 52.1, 0.1);
  EXPECT_NEAR(fin["at_mm"][1].get<double>(), 55, 0.1);
  EXPECT_NEAR(fin["size_mm"][1].get<double>(), 6, 0.3);
  EXPECT_NEAR(fin["layers"][1].get<int>(), 7 / 0.102, 2);
}

TEST_F(CheckVerb, LeavesAFinThatIsThickEnough) {
  EXPECT_EQ(check(block(1.5, 0, false))["lost"], 0);
}

TEST_F(CheckVerb, NamesAWallThatPrintsAndMayBreak) {
  const nlohmann::json said = check(block(1, 0, false));
  EXPECT_EQ(said["verdict"], "prints as it is, but may break");
  EXPECT_EQ(said["thin"], 1);
  EXPECT_EQ(said["narrow"], 0);
  const auto& wall = only(said, "thin");
  EXPECT_NEAR(wall["widest_mm"].get<double>(), 1, 0.05);
  EXPECT_NEAR(wall["at_mm"][0].get<double>(), 52.5, 0.05);
  EXPECT_NEAR(wall["size_mm"][1].get<double>(), 6, 0.2);
  EXPECT_EQ(check(block(2.1, 0, false))["verdict"], "prints as it is");
}

TEST_F(CheckVerb, SaysWhereAGridIsTooCoarseForARuleAndDoesNotAskWhereThereIsNone) {
  std::string text = here_.run({"profile", "show", "z450"}).out;
  const std::size_t at = text.find("[strength]");
  ASSERT_NE(at, std::string::npos);
  const std::string before = text.substr(0, at);
  models::write_obj(block(1, 0, false), here_ / "part.obj");
  const auto check_by = [&](const std::string& strength) {
    std::ofstream(here_ / "own.toml") << before << strength;
    return here_.run(
        {"check", here_ / "part.obj", "-p", here_ / "own.toml", "--enhance", "none", "--json"});
  };
  const Ran coarse = check_by("[strength]\nthinnest_mm = 0.3\n");
  EXPECT_THAT(coarse.err, HasSubstr("cannot tell less than 0.31 mm"));
  EXPECT_TRUE(coarse.json()["thin"].is_null());
  EXPECT_EQ(coarse.json()["verdict"], "prints as it is");
  const Ran none = check_by("");
  EXPECT_TRUE(none.json()["thin"].is_null());
  EXPECT_THAT(none.err, testing::Not(HasSubstr("strength")));
}

TEST_F(CheckVerb, NamesASlotThatCloses) {
  EXPECT_EQ(check(block(0, 0.2, false))["fused"], 1);
  EXPECT_EQ(check(block(0, 1.5, false))["fused"], 0);
}

TEST_F(CheckVerb, NamesAPocketThatKeepsItsPowder) {
  const nlohmann::json said = check(block(0, 0, true));
  EXPECT_EQ(said["trapped"], 1);
  const auto& pocket = said["found"][0];
  EXPECT_EQ(pocket["kind"], "trapped");
  EXPECT_EQ(said["verdict"], "prints as it is, but may break and keeps powder inside")
      << "no detail is lost; its walls are thin";
  EXPECT_NEAR(pocket["volume_mm3"].get<double>(), 32, 2);
}

TEST_F(CheckVerb, NamesTheBridgeThatJoinsTwoParts) {
  // Two bars that are 0.15 mm apart, between y = 4 and 6 only.
  Mesh bars = models::joined(box({0, 0, 0}, {3, 10, 2}), box({3.15, 4, 0}, {6, 6, 2}));
  const nlohmann::json said = check(bars);
  EXPECT_EQ(said["joined"], 1);
  EXPECT_EQ(said["verdict"], "closes gaps and joins parts that are apart");
  const auto& bridge = only(said, "joined");
  EXPECT_NEAR(bridge["at_mm"][0].get<double>(), 53.07, 0.1);
  EXPECT_NEAR(bridge["at_mm"][1].get<double>(), 55, 0.1);
  EXPECT_NEAR(bridge["size_mm"][0].get<double>(), 0.15, 0.06);
  EXPECT_NEAR(bridge["size_mm"][1].get<double>(), 2, 0.15);
  EXPECT_EQ(bridge["layers"], nlohmann::json({0, 20}));
  EXPECT_EQ(check(models::joined(box({0, 0, 0}, {3, 10, 2}), box({5, 4, 0}, {8, 6, 2})))["joined"],
            0);
}

TEST_F(CheckVerb, NamesALoosePiece) {
  // Two blocks on a neck of 0.05 mm, which does not print.
  const Mesh blocks = models::joined(box({0, 0, 0}, {4, 4, 2}), box({6, 0, 0}, {9, 4, 2}));
  const nlohmann::json said =
      check(models::joined(blocks, box({3.9, 1.97, 0.5}, {6.1, 2.02, 1.5})));
  EXPECT_EQ(said["loose"], 1);
  EXPECT_EQ(said["verdict"], "loses detail and comes apart");
  const auto& piece = only(said, "loose");  // the lesser
  EXPECT_NEAR(piece["at_mm"][0].get<double>(), 57.5, 0.15);
  EXPECT_NEAR(piece["size_mm"][0].get<double>(), 3, 0.2);
  EXPECT_EQ(piece["layers"], nlohmann::json({0, 20}));
  EXPECT_EQ(check(models::joined(blocks, box({3.9, 0, 0}, {6.1, 4, 2})))["loose"], 0);
}

// On a printer from whose powder nothing comes out that is thinner than 0.5 mm.
Ran check_coarsely(const Workplace& here, const Mesh& mesh, const std::vector<std::string>& more) {
  models::write_obj(mesh, here / "part.obj");
  const std::string profile = here.text(BINDERJET_SOURCE_DIR "/profiles/z450.toml");
  std::ofstream(here / "coarse.toml") << profile << R"(
[[effects]]
kind = "survive"
width_mm = [0.5, 0.5]
)";
  std::vector<std::string> words = {
      "check", here / "part.obj", "-p", here / "coarse.toml", "--enhance", "none", "--at", "50,50"};
  words.insert(words.end(), more.begin(), more.end());
  return here.run(words);
}

TEST_F(CheckVerb, NamesTheWorstPlacesTheDeepestFirst) {
  Mesh plates = models::joined(box({0, 0, 0}, {0.4, 3, 0.5}), box({4, 0, 0}, {4.3, 3, 0.5}));
  plates = models::joined(plates, box({8, 0, 0}, {10, 3, 0.5}));
  const Ran ran = check_coarsely(here_, plates, {"--json"});
  ASSERT_EQ(ran.status, 0) << ran.err;
  const nlohmann::json said = ran.json();
  const auto& places = said["worst_places"];
  ASSERT_EQ(places.size(), 2) << "each plate once";
  // From the middle of a plate to its sides it is half its width, less at most half a voxel.
  const double voxel_mm = 25.4 / 600;
  EXPECT_EQ(places[0]["kind"], "lost");
  EXPECT_NEAR(places[0]["depth_mm"].get<double>(), 0.2, voxel_mm);
  EXPECT_NEAR(places[0]["at_mm"][0].get<double>(), 50.2, 2 * voxel_mm);
  EXPECT_NEAR(places[1]["depth_mm"].get<double>(), 0.15, voxel_mm);
  EXPECT_NEAR(places[1]["at_mm"][0].get<double>(), 54.15, 2 * voxel_mm);
  for (const auto& place : places) {
    EXPECT_EQ(place["layer"], std::floor(place["at_mm"][2].get<double>() / 0.102));
  }
  EXPECT_THAT(check_coarsely(here_, plates, {}).out,
              HasSubstr(" mm into what is lost at 50.2, 50."));
}

TEST_F(CheckVerb, ReadsAJobInsteadOfSlicingItAgain) {
  models::write_obj(block(0.2, 0.2, true), here_ / "part.obj");
  const std::string job = here_ / "part.bjob";
  ASSERT_EQ(here_
                .run({"slice", here_ / "part.obj", "-p", "z450", "--enhance", "paper", "--at",
                      "50,50", "-o", job, "-q"})
                .status,
            0);
  nlohmann::json of_part = check(block(0.2, 0.2, true), "paper");
  nlohmann::json of_job = here_.run({"check", job, "--json"}).json();
  EXPECT_GT(of_part["lost"], 0);
  EXPECT_GT(of_part["trapped"], 0);
  of_part.erase("warnings");  // of the mesh: said when it was sliced
  of_job.erase("warnings");
  EXPECT_EQ(of_job, of_part);

  const Ran sized = here_.run({"check", job, "--size", "20"});
  EXPECT_EQ(sized.status, 2);
  EXPECT_THAT(sized.err, HasSubstr("--size: is for models"));
  EXPECT_EQ(here_.run({"check", job, here_ / "part.obj", "-p", "z450"}).status, 2);
  EXPECT_EQ(here_.run({"check", here_ / "part.obj"}).status, 2) << "without a printer";
  std::ofstream(here_ / "part.obj", std::ios::app) << "# changed\n";
  const Ran changed = here_.run({"check", job});
  EXPECT_EQ(changed.status, 3);
  EXPECT_THAT(changed.err, HasSubstr("has changed since this job was made"));
}

TEST_F(CheckVerb, SaysWhichLayersOfAShareItKnows) {
  models::write_obj(block(0, 0, true), here_ / "part.obj");
  ASSERT_EQ(here_
                .run({"slice", here_ / "part.obj", "-p", "z450", "--enhance", "none", "--layers",
                      "5:35", "-o", here_ / "share.bjob", "-q"})
                .status,
            0);
  const Ran ran = here_.run({"check", here_ / "share.bjob", "--json"});
  EXPECT_THAT(ran.err, HasSubstr("holds layers 5 to 34 of 40"));
  const nlohmann::json said = ran.json();
  EXPECT_EQ(said["trapped"], 1);
  EXPECT_EQ(only(said, "trapped")["layers"], nlohmann::json({10, 29}))
      << "from the job's first layer";
}

TEST_F(CheckVerb, ListsInItsVerdictAllThatGoesWrong) {
  // Walls and slots of all widths, a hollow, and wedges whose tips are too thin.
  ASSERT_EQ(here_.run({"coupon", "--kind", "full", "-o", here_ / "full.stl", "-q"}).status, 0);
  const Ran ran =
      here_.run({"check", here_ / "full.stl", "-p", "z450", "--enhance", "none", "--json"});
  EXPECT_EQ(ran.json()["verdict"],
            "loses detail, closes gaps, is too thin in places and keeps powder inside");
}

TEST_F(CheckVerb, SaysThatNothingPrints) {
  EXPECT_EQ(check(box({0, 0, 0}, {0.1, 4, 1}))["verdict"], "nothing of it prints");
}

TEST_F(CheckVerb, NamesTheLikelyUnitOfAPartThatIsTooSmallOrTooLarge) {
  models::write_obj(box({0, 0, 0}, {0.14, 0.22, 0.19}), here_ / "meters.obj");
  const Ran meters = here_.run({"check", here_ / "meters.obj", "-p", "z450", "--json"});
  EXPECT_EQ(meters.status, 0);
  EXPECT_EQ(meters.json()["verdict"], "doubtful size");
  EXPECT_THAT(meters.err,
              HasSubstr("probably in meters: say --units m (140.0 x 220.0 x 190.0 mm)"));

  models::write_obj(box({0, 0, 0}, {0.01, 0.01, 0.01}), here_ / "dust.obj");
  const Ran dust = here_.run({"check", here_ / "dust.obj", "-p", "z450", "--json"});
  EXPECT_EQ(dust.json()["verdict"], "nothing to print");

  models::write_obj(box({0, 0, 0}, {4572, 305, 2438}), here_ / "large.obj");
  const Ran large = here_.run({"check", here_ / "large.obj", "-p", "z450"});
  EXPECT_EQ(large.status, 3);
  EXPECT_THAT(large.err, HasSubstr("does not fit the bed"));
  EXPECT_THAT(large.err, HasSubstr("--units um (4.57 x 0.305 x 2.44 mm)"));
}

TEST_F(CheckVerb, SaysWhereToAPerson) {
  models::write_obj(block(0.2, 0, false), here_ / "part.obj");
  const Ran ran = here_.run({"check", here_ / "part.obj", "-p", "z450", "--enhance", "none"});
  EXPECT_THAT(ran.out, HasSubstr("1 feature lost"));
  EXPECT_THAT(ran.out, HasSubstr("verdict: loses detail"));
}

}  // namespace
}  // namespace binderjet
