// SPDX-License-Identifier: GPL-3.0-or-later
// What is left of a slice that was stopped is gone on with, to the same bytes, or not at all.
#include "driver/job/unfinished_slice.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "driver/verbs/program.h"
#include "slicer/base/error.h"
#include "slicer/base/whole_file.h"
#include "tests/support/models.h"
#include "tests/support/program.h"

namespace binderjet::trust {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

// Runs the verb in this process: what it goes on with must come from the same program.
void run(std::vector<std::string> words) {
  words.insert(words.begin(), "binderjet");
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  make_program()->parse(static_cast<int>(argv.size()), argv.data());
}

class UnfinishedSliceTest : public testing::Test {
 protected:
  UnfinishedSliceTest() {
    write_part({255, 0, 0});
    options_.parts = {here_ / "part.obj"};
    options_.profile = "z450";
    options_.enhance = Enhancement::kNone;
    options_.out = here_ / "a.bjob";
    console_.quiet = true;
  }

  void write_part(const Rgb& color) const {
    const Mesh ball = models::sphere(0.6, 3);
    std::ofstream file(here_ / "part.obj");
    for (const Point& p : ball.points) {
      file << "v " << p[0] << ' ' << p[1] << ' ' << p[2] << ' ' << color[0] / 255.0 << ' '
           << color[1] / 255.0 << ' ' << color[2] / 255.0 << '\n';
    }
    for (const Triangle& t : ball.triangles) {
      file << "f " << t[0] + 1 << ' ' << t[1] + 1 << ' ' << t[2] + 1 << '\n';
    }
  }
  std::vector<std::string> words(const std::vector<std::string>& more = {}) const {
    std::vector<std::string> words = {"slice",     options_.parts.front(), "-p", "z450",      "-q",
                                      "--enhance", word(options_.enhance), "-o", options_.out};
    words.insert(words.end(), more.begin(), more.end());
    return words;
  }
  // The job as it is when nothing comes between.
  std::string whole(const std::vector<std::string>& more = {}) const {
    const fs::path aside = here_ / "aside";
    fs::create_directory(aside);
    std::vector<std::string> all = words(more);
    for (std::string& word : all) {
      if (word == options_.out) word = aside / "a.bjob";
    }
    run(all);
    return here_.text("aside/a.bjob");
  }
  // Leaves a slice with its first `layers` layers, as a kill does.
  void stop_after(int layers) const {
    const SlicePlan plan = plan_slices(options_, console_);
    const LayerRange range = layer_range(options_.layers, plan.header.layers());
    UnfinishedSlice slice(options_.out, plan, range, false, console_);
    slice.append(encoded_layers(plan.header, plan.mesh, plan.color).layers(range)->next(layers));
  }
  // What stands beside the job and its model.
  std::vector<std::string> left() const {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(here_ / ".")) {
      const std::string name = entry.path().filename();
      if (name.starts_with("a.bjob.")) names.push_back(here_ / name);
    }
    return names;
  }
  std::string left(const std::string& end) const {
    for (const std::string& path : left()) {
      if (path.ends_with(end)) return path;
    }
    return "";
  }
  // How many layers the next slice finds.
  int kept() const {
    const SlicePlan plan = plan_slices(options_, console_);
    const LayerRange range = layer_range(options_.layers, plan.header.layers());
    return UnfinishedSlice(options_.out, plan, range, false, console_).totals().layers;
  }

  Workplace here_;
  SliceOptions options_;
  Console console_;
};

TEST_F(UnfinishedSliceTest, IsGoneOnWithToTheSameBytes) {
  const std::string bytes = whole();
  stop_after(5);
  EXPECT_THAT(left(), SizeIs(2));
  EXPECT_EQ(kept(), 5);
  run(words());
  EXPECT_EQ(here_.text("a.bjob"), bytes);
  EXPECT_THAT(left(), IsEmpty());
}

TEST_F(UnfinishedSliceTest, IsAlsoAShare) {
  options_.layers = "3:9";
  const std::string bytes = whole({"--layers", "3:9"});
  stop_after(4);
  EXPECT_EQ(kept(), 4);
  run(words({"--layers", "3:9"}));
  EXPECT_EQ(here_.text("a.bjob"), bytes);
  EXPECT_THAT(left(), IsEmpty());
}

// A kill cuts, a loss of power also leaves zeros; the totals may have come further than the layers
// or, after a loss of power, less far.
TEST_F(UnfinishedSliceTest, MayEndAnywhere) {
  const std::string bytes = whole();
  stop_after(6);
  const std::string part = left(".part");
  const std::string totals = left(".totals");
  const std::string part_text = here_.text(fs::path(part).filename());
  const std::string totals_text = here_.text(fs::path(totals).filename());
  const std::size_t step = part_text.size() / 40;
  for (std::size_t cut = 0; cut <= part_text.size(); cut += step) {
    SCOPED_TRACE(cut);
    const bool zeros = cut / step % 2 == 1;
    std::ofstream(part) << part_text.substr(0, cut) << std::string(zeros ? 5000 : 0, '\0');
    std::ofstream(totals) << totals_text.substr(0, totals_text.size() - cut / step % 3);
    run(words());
    ASSERT_EQ(here_.text("a.bjob"), bytes);
    ASSERT_THAT(left(), IsEmpty());
  }
}

TEST_F(UnfinishedSliceTest, SaysHowMuchOfAJobItWas) {
  whole();
  stop_after(5);
  testing::internal::CaptureStdout();
  run(words({"--json"}));
  const nlohmann::json resumed = nlohmann::json::parse(testing::internal::GetCapturedStdout());
  testing::internal::CaptureStdout();
  run(words({"--json"}));
  const nlohmann::json anew = nlohmann::json::parse(testing::internal::GetCapturedStdout());
  EXPECT_EQ(resumed["kept_layers"], 5);
  EXPECT_EQ(anew["kept_layers"], 0);
  for (const char* key : {"layers", "solid_voxels", "mask_pixels", "binder_ml"}) {
    EXPECT_EQ(resumed[key], anew[key]) << key;
  }
}

TEST_F(UnfinishedSliceTest, IsNotTakenForThatOfAnotherOptionOrModel) {
  stop_after(5);
  const std::string first = left(".part");
  options_.enhance = Enhancement::kPaper;
  EXPECT_EQ(kept(), 0);
  EXPECT_THAT(left(), testing::Contains(first)) << "kept until the other slice is done";
  run(words());
  EXPECT_EQ(here_.text("a.bjob"), whole());
  EXPECT_THAT(left(), IsEmpty());
  stop_after(5);
  options_.layers = "0:8";
  EXPECT_EQ(kept(), 0);
  options_.layers = "";
  EXPECT_EQ(kept(), 5);
  write_part({0, 0, 255});
  EXPECT_EQ(kept(), 0);
}

// The header names the model's file, and nothing of what that leads to.
TEST_F(UnfinishedSliceTest, IsNotTakenForThatOfAnotherTexture) {
  const auto write_texture = [this](char level) {
    std::ofstream(here_ / "t.ppm") << "P6 1 1 255\n" << level << level << level;
  };
  std::ofstream(here_ / "m.mtl") << "newmtl m\nmap_Kd t.ppm\n";
  std::ofstream(here_ / "part.obj")
      << "mtllib m.mtl\nusemtl m\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n"
         "vt 0 0\nvt 1 0\nvt 0 1\nf 1/1 3/2 2/3\nf 1/1 2/2 4/3\n"
         "f 1/1 4/2 3/3\nf 2/1 3/2 4/3\n";
  write_texture('A');
  stop_after(5);
  EXPECT_EQ(kept(), 5);
  write_texture('B');
  EXPECT_EQ(kept(), 0);
}

TEST_F(UnfinishedSliceTest, BeginsAnewWhereThatIsAskedFor) {
  const std::string bytes = whole();
  stop_after(5);
  const std::string part = left(".part");
  testing::internal::CaptureStdout();
  run(words({"--restart", "--json"}));
  EXPECT_EQ(nlohmann::json::parse(testing::internal::GetCapturedStdout())["kept_layers"], 0);
  EXPECT_EQ(here_.text("a.bjob"), bytes);
  EXPECT_THAT(left(), IsEmpty());
}

TEST_F(UnfinishedSliceTest, IsSliceByOneProcessOnly) {
  const SlicePlan plan = plan_slices(options_, console_);
  const LayerRange all{0, plan.header.layers()};
  const UnfinishedSlice slice(options_.out, plan, all, false, console_);
  EXPECT_THROW(UnfinishedSlice(options_.out, plan, all, false, console_), Error);
}

TEST_F(UnfinishedSliceTest, LeavesNothingWithoutALayer) {
  stop_after(0);
  EXPECT_THAT(left(), IsEmpty());
}

TEST_F(UnfinishedSliceTest, LeavesLayersButNothingWithoutOneWhenItMustEndAtOnce) {
  const SlicePlan plan = plan_slices(options_, console_);
  const LayerRange all{0, plan.header.layers()};
  const auto first = encoded_layers(plan.header, plan.mesh, plan.color).layers(all)->next(1);
  for (const bool with_a_layer : {false, true}) {
    const auto end_at_once = [&] {
      UnfinishedSlice slice(options_.out, plan, all, false, console_);
      if (with_a_layer) slice.append(first);
      remove_unfinished();
      _exit(0);
    };
    EXPECT_EXIT(end_at_once(), testing::ExitedWithCode(0), "");
    EXPECT_THAT(left(), SizeIs(with_a_layer ? 2 : 0));
  }
}

TEST_F(UnfinishedSliceTest, LeavesFilesAloneThatOnlyHaveItsNames) {
  const std::string diary = options_.out + ".0123456789abcdef";
  std::ofstream(diary + ".part") << "my diary";
  std::ofstream(diary + ".totals") << "my sums";
  run(words());
  EXPECT_THAT(left(), testing::UnorderedElementsAre(diary + ".part", diary + ".totals"));
}

TEST_F(UnfinishedSliceTest, ReplacesNoFileThatCameMeanwhileAndIsNoJob) {
  stop_after(5);
  std::ofstream(options_.out) << "my thesis";
  EXPECT_THROW(run(words()), Error);
  EXPECT_EQ(here_.text("a.bjob"), "my thesis");
}

TEST_F(UnfinishedSliceTest, IsNamedByTheErrorThatEndsIt) {
  const SlicePlan plan = plan_slices(options_, console_);
  UnfinishedSlice slice(options_.out, plan, {0, plan.header.layers()}, false, console_);
  EXPECT_EQ(slice.kept(), "");
  slice.append(encoded_layers(plan.header, plan.mesh, plan.color).all_layers()->next(3));
  EXPECT_THAT(slice.kept(), HasSubstr("layers 0 to 2 of 12 are kept in " + left(".part")));
}

}  // namespace
}  // namespace binderjet::trust
