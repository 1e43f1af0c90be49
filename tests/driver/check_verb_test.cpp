// SPDX-License-Identifier: GPL-3.0-or-later
// check finds, in a part made for it, what the printer will do to it, and where.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/models.h"
#include "tests/support/program.h"

namespace binderjet {
namespace {

using models::box;
using testing::HasSubstr;

class CheckVerb : public testing::Test {
 protected:
  nlohmann::json check(const Mesh& mesh, const std::vector<std::string>& more = {}) const {
    models::write_obj(mesh, here_ / "part.obj");
    std::vector<std::string> words = {
        "check", here_ / "part.obj", "-p", "z450", "--enhance", "none", "--at", "50,50"};
    words.insert(words.end(), more.begin(), more.end());
    words.emplace_back("--json");
    const Ran ran = here_.run(words);
    EXPECT_EQ(ran.status, 0) << ran.err;
    return ran.json();
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
  EXPECT_NEAR(said["powder_ml"].get<double>(), 0.4, 0.01);
  EXPECT_NEAR(said["binder_ml"].get<double>(), 0.4 * 0.36, 0.01);
  EXPECT_NEAR(said["print_minutes"].get<double>(), 90 + 40 / 3.0, 1);  // 40 layers, 3 a minute
}

TEST_F(CheckVerb, NamesAFinThatVanishesWithItsPlaceAndSize) {
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

TEST_F(CheckVerb, NamesASlotThatCloses) {
  EXPECT_EQ(check(block(0, 0.2, false))["fused"], 1);
  EXPECT_EQ(check(block(0, 1.5, false))["fused"], 0);
}

TEST_F(CheckVerb, NamesAPocketThatKeepsItsPowder) {
  const nlohmann::json said = check(block(0, 0, true));
  EXPECT_EQ(said["trapped"], 1);
  const auto& pocket = said["found"][0];
  EXPECT_EQ(pocket["kind"], "trapped");
  EXPECT_NEAR(pocket["volume_mm3"].get<double>(), 32, 2);
}

TEST_F(CheckVerb, SaysWhereToAPerson) {
  models::write_obj(block(0.2, 0, false), here_ / "part.obj");
  const Ran ran = here_.run({"check", here_ / "part.obj", "-p", "z450", "--enhance", "none"});
  EXPECT_THAT(ran.out, HasSubstr("1 feature vanishes"));
  EXPECT_THAT(ran.out, HasSubstr("verdict: loses detail"));
}

}  // namespace
}  // namespace binderjet
