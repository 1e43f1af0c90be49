// SPDX-License-Identifier: GPL-3.0-or-later
// A stack replaces an earlier stack, and nothing else of anybody's.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>
#include <fstream>

#include "slicer/base/error.h"
#include "slicer/stack/slice_stack.h"
#include "tests/slicer/color/colored_layers.h"

namespace binderjet {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::UnorderedElementsAre;

StackInfo info_of(int images) {
  StackInfo info;
  info.kind = StackKind::kMask;
  info.size = {8, 2, images};
  info.pitch_mm = {0.1, 0.1, 0.1};
  info.files = "mask_%06d.png";
  return info;
}

class ReplaceStack : public ::testing::Test {
 protected:
  void write(int images, const std::string& also = "") const {
    StackWriter stack(at_, info_of(images));
    RunLayer layer(8);
    layer.reserve(2, 0);
    for (int y = 0; y < 2; ++y) layer.append_row_where([](int x) { return x < 3; });
    for (int i = 0; i < images; ++i) stack.write(i, layer);
    const std::string text = "{}";
    if (!also.empty()) stack.add_file(also, std::as_bytes(std::span(text)));
    stack.finish();
  }
  std::string refusal() const {
    try {
      write(1);
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::kUsage);
      return error.what();
    }
    return "written";
  }
  std::vector<std::string> names(const fs::path& folder) const {
    std::vector<std::string> found;
    for (const auto& entry : fs::directory_iterator(folder)) {
      found.push_back(entry.path().filename());
    }
    return found;
  }
  void put(const std::string& name) const { std::ofstream(at_ + "/" + name) << "mine"; }

  const colored::Folder folder_;
  const std::string at_ = folder_.file("stack");
};

TEST_F(ReplaceStack, TakesTheEarlierOnesFilesAway) {
  write(3, "features.json");
  write(1);
  EXPECT_THAT(names(at_), UnorderedElementsAre("stack.json", "mask_000000.png"));
  EXPECT_THAT(names(fs::path(at_).parent_path()), UnorderedElementsAre("stack"));
}

TEST_F(ReplaceStack, RefusesAFolderWithAFileThatIsNotOfIt) {
  for (const char* name : {"thesis.txt", "mask_000003.png", ".hidden", "features.json"}) {
    write(3);
    put(name);
    EXPECT_THAT(refusal(), HasSubstr(std::string("holds ") + name)) << name;
    EXPECT_TRUE(fs::exists(at_ + "/" + name)) << name;
    fs::remove(at_ + "/" + name);
  }
  fs::create_directory(at_ + "/more");
  EXPECT_THAT(refusal(), HasSubstr("holds more"));
  fs::remove(at_ + "/more");
  fs::remove(at_ + "/mask_000001.png");
  fs::create_directory(at_ + "/mask_000001.png");
  EXPECT_THAT(refusal(), HasSubstr("holds mask_000001.png")) << "a folder of that name";
}

TEST_F(ReplaceStack, RefusesWhatIsNoStack) {
  fs::create_directory(at_);
  put("stack.json");
  EXPECT_THAT(refusal(), HasSubstr("not a slice stack")) << "a file of that name alone";
  fs::remove_all(at_);
  std::ofstream(at_) << "a file";
  EXPECT_THAT(refusal(), HasSubstr("not a slice stack"));
  fs::remove(at_);
  fs::create_directory(folder_.file("elsewhere"));
  fs::create_directory_symlink(folder_.file("elsewhere"), at_);
  EXPECT_THAT(refusal(), HasSubstr("not a slice stack")) << "a link";
}

TEST_F(ReplaceStack, LeavesWhatCameWhileItWasWritten) {
  write(2);
  StackWriter stack(at_, info_of(1));
  stack.write(0, [] {
    RunLayer layer(8);
    layer.reserve(2, 0);
    for (int y = 0; y < 2; ++y) layer.append_row_where([](int) { return true; });
    return layer;
  }());
  put("letter.txt");
  EXPECT_THROW(stack.finish(), Error);
  EXPECT_TRUE(fs::exists(at_ + "/letter.txt"));
  EXPECT_TRUE(fs::exists(at_ + "/mask_000001.png")) << "the earlier stack still stands";
}

TEST_F(ReplaceStack, IsForWhomTheUmaskLets) {
  const mode_t before = umask(077);
  write(1);
  umask(before);
  EXPECT_EQ(fs::status(at_).permissions(), fs::perms(0700));
}

}  // namespace
}  // namespace binderjet
