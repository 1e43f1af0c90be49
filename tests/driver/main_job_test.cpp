// SPDX-License-Identifier: GPL-3.0-or-later
// The main job, from a model file to a slice stack and a spool, with the program itself.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <regex>

#include "slicer/mesh/boundary.h"
#include "slicer/mesh/read/read_mesh.h"
#include "slicer/stack/slice_stack.h"
#include "tests/support/models.h"
#include "tests/support/program.h"

namespace binderjet {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

class MainJob : public testing::Test {
 protected:
  MainJob() { models::write_obj(models::golf_ball(5, 4), model_); }

  std::string slice(const std::string& job, const std::vector<std::string>& more = {}) const {
    std::vector<std::string> words = {"slice", model_, "-p", "z450", "-o", here_ / job, "-q"};
    // What a job is does not depend on its masks, and plain ones are made at once.
    if (std::find(more.begin(), more.end(), "--enhance") == more.end()) {
      words.insert(words.end(), {"--enhance", "none"});
    }
    words.insert(words.end(), more.begin(), more.end());
    const Ran ran = here_.run(words);
    EXPECT_EQ(ran.status, 0) << ran.err;
    return here_.text(job);
  }
  // The masks of a job as one text of bits, without their place on the bed.
  std::string masks(const std::string& job) const {
    EXPECT_EQ(here_.run({"export", here_ / job, "-o", here_ / "stack", "-q"}).status, 0);
    const StackReader stack(here_ / "stack");
    std::string bits;
    for (int k = 0; k < stack.info().size[2]; ++k) {
      for (const std::byte byte : pack(stack.read(k))) bits.push_back(static_cast<char>(byte));
    }
    return bits;
  }

  Workplace here_;
  std::string model_ = here_ / "model.obj";
};

TEST_F(MainJob, TurnsAModelIntoAStackAndASpooledJob) {
  slice("a.bjob");
  ASSERT_EQ(here_.run({"export", here_ / "a.bjob", "-o", here_ / "masks"}).status, 0);
  const StackReader stack(here_ / "masks");
  EXPECT_EQ(stack.info().kind, StackKind::kMask);
  EXPECT_EQ(stack.info().size[2], 98);  // 10 mm less a dimple in layers of 0.102
  EXPECT_GT(stack.read(49).count(), 15000);
  const Ran printed =
      here_.run({"print", here_ / "a.bjob", "--to", "spool:" + (here_ / "spool"), "--json"});
  ASSERT_EQ(printed.status, 0) << printed.err;
  const std::string id = printed.json()["job"];
  EXPECT_EQ(here_.text("spool/done/" + id + ".bjob"), here_.text("a.bjob"));
}

TEST_F(MainJob, GivesTheSameJobWithAnyNumberOfThreads) {
  const std::string one = slice("a.bjob", {"--threads", "1"});
  EXPECT_EQ(slice("b.bjob", {"--threads", "2"}), one);
  EXPECT_EQ(slice("c.bjob"), one);
}

// The model's largest side is 10 mm less a dimple; what size it has nobody need know.
TEST_F(MainJob, MakesAPartOfTheSizeAskedForAndSaysIt) {
  const Ran ran = here_.run({"slice", model_, "-p", "z450", "--enhance", "none", "--units", "in",
                             "--size", "6", "-o", here_ / "a.bjob"});
  ASSERT_EQ(ran.status, 0) << ran.err;
  EXPECT_TRUE(std::regex_search(ran.err, std::regex("model.obj: [56].[0-9] x 6.0 x [56].[0-9] mm\n|"
                                                    "model.obj: 6.0 x |x 6.0 mm\n")))
      << ran.err;
  here_.run({"export", here_ / "a.bjob", "-o", here_ / "size"});
  EXPECT_EQ(StackReader(here_ / "size").info().size[2], 59);  // 6 mm in layers of 0.102
  EXPECT_EQ(here_
                .run({"slice", model_, "-p", "z450", "--size", "6", "--scale", "2", "-o",
                      here_ / "b.bjob"})
                .status,
            2);
}

TEST_F(MainJob, GivesTheSameMasksAnywhereOnTheBed) {
  slice("a.bjob");
  const std::string center = masks("a.bjob");
  for (const std::string at : {"0.5,0.5", "17.123,201.9", "190,3"}) {
    slice("b.bjob", {"--at", at});
    EXPECT_EQ(masks("b.bjob"), center) << at;
  }
}

TEST_F(MainJob, JoinsSevenSharesToTheSameBytes) {
  for (const std::string enhance : {"none", "paper"}) {
    const std::string whole = slice("a.bjob", {"--enhance", enhance});
    std::vector<std::string> join = {"join"};
    for (int share = 0; share < 7; ++share) {
      const std::string name = "share" + std::to_string(share) + ".bjob";
      slice(name, {"--enhance", enhance, "--layers",
                   std::to_string(share * 98 / 7) + ":" + std::to_string((share + 1) * 98 / 7)});
      join.push_back(here_ / name);
    }
    join.insert(join.end(), {"-o", here_ / "joined.bjob", "-q"});
    const Ran joined = here_.run(join);
    ASSERT_EQ(joined.status, 0) << joined.err;
    EXPECT_EQ(here_.text("joined.bjob"), whole);
  }
}

TEST_F(MainJob, PutsThePartInItsPlaceOnTheFullBed) {
  slice("a.bjob", {"--at", "30,40"});
  ASSERT_EQ(here_.run({"export", here_ / "a.bjob", "-o", here_ / "bed", "--full-bed"}).status, 0);
  const StackReader bed(here_ / "bed");
  EXPECT_EQ(bed.info().size, (std::array<int, 3>{2398, 4500, 98}));
  const RunLayer layer = bed.read(49);
  int left = layer.width();
  for (int y = 0; y < layer.height(); ++y) {
    if (!layer.row(y).empty()) left = std::min(left, layer.row(y).front());
  }
  EXPECT_NEAR(left * 25.4 / 300, 30, 0.2);
}

TEST_F(MainJob, ExportsTheTargetWithTheVolumeOfTheModel) {
  slice("a.bjob");
  ASSERT_EQ(here_.run({"export", here_ / "a.bjob", "-o", here_ / "t", "--what", "target"}).status,
            0);
  const StackReader target(here_ / "t");
  std::int64_t voxels = 0;
  for (int k = 0; k < target.info().size[2]; ++k) voxels += target.read(k).count();
  const auto& pitch = target.info().pitch_mm;
  const double volume = static_cast<double>(voxels) * pitch[0] * pitch[1] * pitch[2];
  EXPECT_NEAR(volume / signed_volume(read_mesh(model_).mesh), 1, 1e-3);
}

TEST_F(MainJob, SlicesTheCuberilleBackToTheSameMasks) {
  slice("a.bjob");
  ASSERT_EQ(here_.run({"export", here_ / "a.bjob", "--cuberille", here_ / "c.ply"}).status, 0);
  slice("a.bjob");
  const std::string direct = masks("a.bjob");
  ASSERT_EQ(here_
                .run({"slice", here_ / "c.ply", "-p", "z450", "--enhance", "none", "-o",
                      here_ / "b.bjob", "-q"})
                .status,
            0);
  EXPECT_EQ(masks("b.bjob"), direct);
}

TEST_F(MainJob, RefusesATargetWhoseModelHasChanged) {
  slice("a.bjob");
  models::write_obj(models::sphere(3, 3), model_);
  const Ran ran = here_.run({"export", here_ / "a.bjob", "-o", here_ / "t", "--what", "target"});
  EXPECT_EQ(ran.status, 3);
  EXPECT_THAT(ran.err, HasSubstr("has changed since this job was made"));
}

TEST_F(MainJob, LeavesNothingUnderAFinalNameWhenItFails) {
  std::ofstream(here_ / "bad.obj") << "v 0 0 0\nf 1 2 3\n";
  EXPECT_EQ(here_.run({"slice", here_ / "bad.obj", "-p", "z450", "-o", here_ / "x.bjob"}).status,
            3);
  EXPECT_FALSE(fs::exists(here_ / "x.bjob"));
  fs::create_directory(here_ / "photos");
  std::ofstream(here_ / "photos/cat.jpg") << "meow";
  slice("a.bjob");
  const Ran ran = here_.run({"export", here_ / "a.bjob", "-o", here_ / "photos"});
  EXPECT_EQ(ran.status, 2);
  EXPECT_EQ(here_.text("photos/cat.jpg"), "meow");
}

TEST_F(MainJob, TellsAMachineWhatItDid) {
  const Ran ran = here_.run(
      {"slice", model_, "-p", "z450", "--enhance", "none", "-o", here_ / "a.bjob", "--json"});
  const nlohmann::json json = ran.json();
  for (const char* key : {"layers", "size_px", "solid_voxels", "seconds", "peak_rss_mb",
                          "print_minutes", "binder_ml", "warnings"}) {
    EXPECT_TRUE(json.contains(key)) << key;
  }
  EXPECT_EQ(json["layers"], 98);
  EXPECT_NEAR(json["print_minutes"], 98 / 3.0 + 90, 1e-9);  // 3 layers a minute, then drying
}

TEST_F(MainJob, StaysWithin256MiBOnAFullBed) {
  ASSERT_EQ(here_.run({"coupon", "--kind", "golfball", "-o", here_ / "ball.stl"}).status, 0);
  for (const std::string enhance : {"none", "paper"}) {
    const Ran ran =
        here_.run({"slice", here_ / "ball.stl", "--scale", "4.4496", "-p", "z450", "-o",
                   here_ / "ball.bjob", "--enhance", enhance, "--layers", "600:760", "--json"});
    ASSERT_EQ(ran.status, 0) << ran.err;
    EXPECT_GT(ran.json()["size_px"][0], 2240);
    EXPECT_GT(ran.json()["size_px"][1], 3360);
    EXPECT_LT(ran.peak_rss_mb, 256) << enhance;
  }
}

TEST_F(MainJob, StaysWithin512MiBOnAFullBedUnlessToldOtherwise) {
  ASSERT_EQ(here_.run({"coupon", "--kind", "golfball", "-o", here_ / "ball.stl"}).status, 0);
  const Ran ran = here_.run({"slice", here_ / "ball.stl", "--scale", "4.4496", "-p", "z450", "-o",
                             here_ / "ball.bjob", "--layers", "600:602", "--json"});
  ASSERT_EQ(ran.status, 0) << ran.err;
  EXPECT_LT(ran.peak_rss_mb, 512);
}

TEST_F(MainJob, GivesEveryCleanModelItsVolume) {
  const fs::path data = data_folder();
  if (data.empty()) GTEST_SKIP() << "the clean models are not here (BINDERJET_DATA)";
  // Some clean models are flat, so at 30 mm height they need a larger bed.
  std::string profile;
  {
    std::ifstream file(std::string(BINDERJET_SOURCE_DIR) + "/profiles/z450.toml");
    profile.assign(std::istreambuf_iterator<char>(file), {});
  }
  const std::size_t size = profile.find("[203, 254, 204]");
  ASSERT_NE(size, std::string::npos);
  std::ofstream(here_ / "large.toml") << profile.replace(size, 15, "[900, 900, 900]");
  for (const fs::directory_entry& entry : fs::directory_iterator(data / "models" / "clean")) {
    const MeshFile file = read_mesh(entry.path().string());
    const double scale = 30 / (bounding_box(file.mesh).size(2) * file.unit_mm);
    const Ran ran =
        here_.run({"slice", entry.path().string(), "--scale", std::to_string(scale), "-p",
                   here_ / "large.toml", "-o", here_ / "m.bjob", "--enhance", "none", "--json"});
    ASSERT_EQ(ran.status, 0) << ran.err;
    const double voxel = 25.4 / 600 * 25.4 / 900 * 0.051;
    const double factor = std::stod(std::to_string(scale)) * file.unit_mm;
    const double wanted = signed_volume(file.mesh) * std::pow(factor, 3);
    const double ratio = ran.json()["solid_voxels"].get<double>() * voxel / wanted;
    std::printf("%-24s %.6f\n", entry.path().filename().c_str(), ratio);
    EXPECT_NEAR(ratio, 1, 1e-3) << entry.path();
  }
}

TEST_F(MainJob, EndsWellOnEveryNastyFile) {
  const fs::path data = data_folder();
  if (data.empty()) GTEST_SKIP() << "the nasty models are not here (BINDERJET_DATA)";
  for (const fs::directory_entry& entry : fs::directory_iterator(data / "models" / "nasty")) {
    const Ran ran = here_.run({"slice", entry.path().string(), "-p", "z450", "-o", here_ / "n.bjob",
                               "--enhance", "none", "--json"},
                              10);
    EXPECT_LT(ran.peak_rss_mb, 1024) << entry.path();
    const auto lines = std::count(ran.err.begin(), ran.err.end(), '\n');
    if (ran.status == 0) {
      EXPECT_FALSE(ran.json()["warnings"].empty()) << entry.path();
    } else {
      EXPECT_EQ(ran.status, 3) << entry.path() << ran.err;
      EXPECT_EQ(lines, 1) << ran.err;
    }
  }
}

}  // namespace
}  // namespace binderjet
