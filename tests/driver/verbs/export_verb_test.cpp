// SPDX-License-Identifier: GPL-3.0-or-later
// export of several kinds in one call.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>

#include "slicer/stack/slice_stack.h"
#include "tests/support/models.h"
#include "tests/support/program.h"

namespace binderjet {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::UnorderedElementsAre;

class ExportVerb : public testing::Test {
 protected:
  ExportVerb() {
    const Mesh ball = models::golf_ball(2, 4);
    std::ofstream file(here_ / "ball.obj");
    for (const Point& p : ball.points) {
      file << "v " << p[0] << ' ' << p[1] << ' ' << p[2] << (p[1] < 0 ? " 1 0 0\n" : " 0 0 1\n");
    }
    for (const Triangle& t : ball.triangles) {
      file << "f " << t[0] + 1 << ' ' << t[1] + 1 << ' ' << t[2] + 1 << '\n';
    }
    file.close();
    const Ran ran = here_.run(
        {"slice", here_ / "ball.obj", "-p", "z450", "--enhance", "none", "-o", here_ / "a.bjob"});
    EXPECT_EQ(ran.status, 0) << ran.err;
  }
  Ran run(const std::vector<std::string>& more) const {
    std::vector<std::string> words = {"export", here_ / "a.bjob", "--json"};
    words.insert(words.end(), more.begin(), more.end());
    return here_.run(words);
  }
  // All files below a folder or a file, with their bytes.
  std::map<std::string, std::string> tree(const std::string& name) const {
    std::map<std::string, std::string> files;
    const std::filesystem::path top = here_ / name;
    if (std::filesystem::is_regular_file(top)) return {{"", here_.text(name)}};
    for (const auto& entry : std::filesystem::recursive_directory_iterator(top)) {
      if (entry.is_directory()) continue;
      const std::string file = entry.path().lexically_relative(top).string();
      files[file] = here_.text(name + "/" + file);
    }
    return files;
  }
  std::vector<std::string> names(const std::string& folder) const {
    std::vector<std::string> all;
    for (const auto& entry : std::filesystem::directory_iterator(here_ / folder)) {
      all.push_back(entry.path().filename().string());
    }
    return all;
  }

  Workplace here_;
};

TEST_F(ExportVerb, WritesInOneCallWhatItWritesInMany) {
  const Ran ran =
      run({"-o", here_ / "all", "--what", "mask,color", "--what", "target", "--what", "printed",
           "--separate", "cmy", "--html", here_ / "all.html", "--3mf", here_ / "all.3mf", "--zip",
           here_ / "all.zip", "--cuberille", here_ / "all.ply"});
  ASSERT_EQ(ran.status, 0) << ran.err;
  EXPECT_THAT(names("all"), UnorderedElementsAre("mask", "color", "target", "printed", "cyan",
                                                 "magenta", "yellow"));
  for (const std::string what : {"mask", "color", "target", "printed"}) {
    ASSERT_EQ(run({"-o", here_ / what, "--what", what}).status, 0);
    EXPECT_EQ(tree("all/" + what), tree(what)) << what;
  }
  ASSERT_EQ(run({"-o", here_ / "inks", "--separate", "cmy"}).status, 0);
  for (const std::string ink : {"cyan", "magenta", "yellow"}) {
    EXPECT_EQ(tree("all/" + ink), tree("inks/" + ink)) << ink;
  }
  for (const auto& [option, ending] :
       {std::pair("--html", "html"), std::pair("--3mf", "3mf"), std::pair("--zip", "zip"),
        std::pair("--cuberille", "ply")}) {
    ASSERT_EQ(run({option, here_ / (std::string("one.") + ending)}).status, 0);
    EXPECT_EQ(tree(std::string("all.") + ending), tree(std::string("one.") + ending)) << ending;
  }
}

TEST_F(ExportVerb, SaysEachOutput) {
  const Ran ran = run({"-o", here_ / "all", "--what", "mask,target", "--zip", here_ / "a.zip"});
  ASSERT_EQ(ran.status, 0) << ran.err;
  const nlohmann::json json = ran.json();
  std::vector<std::string> what;
  for (const auto& one : json["outputs"]) what.push_back(one["what"]);
  EXPECT_THAT(what, ElementsAre("mask", "target", "zip"));
  EXPECT_EQ(json["outputs"][1]["out"], here_ / "all/target");
  EXPECT_GT(json["layers"], 10);
  EXPECT_FALSE(json.contains("out"));
}

TEST_F(ExportVerb, SaysOneOutputAsItAlwaysDid) {
  const auto json = run({"-o", here_ / "masks"}).json();
  EXPECT_EQ(json["out"], here_ / "masks");
  EXPECT_EQ(json["what"], "mask");
  EXPECT_EQ(json["outputs"].size(), 1U);
}

TEST_F(ExportVerb, RefusesToReplaceItsInputsOrItsOwnOutputs) {
  const std::string job = here_.text("a.bjob");
  for (const std::vector<std::string>& words :
       {std::vector{std::string("--zip"), here_ / "a.bjob"},
        std::vector{std::string("--html"), here_ / "./ball.obj"},
        std::vector{std::string("--zip"), here_ / "x", std::string("--html"), here_ / "x"},
        std::vector{std::string("-o"), here_ / "x", std::string("--html"), here_ / "x/page.html"},
        std::vector{std::string("-o"), here_ / "."}}) {
    const Ran ran = run(words);
    EXPECT_EQ(ran.status, 2) << ran.err;
  }
  EXPECT_EQ(here_.text("a.bjob"), job);
  EXPECT_FALSE(std::filesystem::exists(here_ / "x"));
}

TEST_F(ExportVerb, LeavesNoneWhereOneFails) {
  const Ran ran = run({"-o", here_ / "all", "--what", "mask,color", "--zip", here_ / "a.zip",
                       "--html", here_ / "missing/a.html"});
  EXPECT_EQ(ran.status, 3) << ran.err;
  EXPECT_THAT(ran.err, HasSubstr("missing/a.html"));
  EXPECT_FALSE(std::filesystem::exists(here_ / "a.zip"));
  if (std::filesystem::exists(here_ / "all")) {
    EXPECT_THAT(names("all"), IsEmpty());
  }
  EXPECT_THAT(names("."), testing::Each(testing::Not(HasSubstr(".part-"))));
}

TEST_F(ExportVerb, WantsAFolderForStacks) {
  EXPECT_EQ(run({"--what", "mask", "--zip", here_ / "a.zip"}).status, 2);
  EXPECT_EQ(run({"--separate", "cmy", "--zip", here_ / "a.zip"}).status, 2);
  EXPECT_EQ(run({}).status, 2);
}

}  // namespace
}  // namespace binderjet
