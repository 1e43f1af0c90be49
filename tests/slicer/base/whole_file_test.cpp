// SPDX-License-Identifier: GPL-3.0-or-later
// A file is there whole or not at all, and so is an archive.
#include "slicer/base/whole_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "slicer/base/error.h"
#include "slicer/stack/slice_stack.h"
#include "slicer/stack/zip_writer.h"
#include "tests/slicer/color/colored_layers.h"
#include "tests/support/archive.h"

namespace binderjet {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

std::vector<std::string> names_in(const std::string& folder) {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    names.push_back(entry.path().filename());
  }
  std::sort(names.begin(), names.end());
  return names;
}

TEST(WholeFile, HasNoNameUntilItIsKept) {
  const colored::Folder folder;
  {
    const WholeFile file(folder.file("a"));
    write_file(file.part(), {});
    EXPECT_FALSE(std::filesystem::exists(folder.file("a")));
  }
  EXPECT_THAT(names_in(folder.file("")), IsEmpty());
  WholeFile file(folder.file("a"));
  file.keep();
  EXPECT_THAT(names_in(folder.file("")), ElementsAre("a"));
}

TEST(WholeFile, GoesWithAProgramThatMustEndAtOnce) {
  const colored::Folder folder;
  const auto end_at_once = [&] {
    const WholeFile file(folder.file("a"));
    write_file(file.part(), {});
    StackWriter stack(folder.file("stack"), StackInfo());
    WholeFile kept(folder.file("kept"));
    kept.keep();
    remove_unfinished();
    _exit(0);
  };
  EXPECT_EXIT(end_at_once(), testing::ExitedWithCode(0), "");
  EXPECT_THAT(names_in(folder.file("")), ElementsAre("kept"));
}

TEST(OutputFolder, GoesAgainIfItIsNewAndEmpty) {
  const colored::Folder folder;
  { const OutputFolder out(folder.file("new")); }
  EXPECT_THAT(names_in(folder.file("")), IsEmpty());
  {
    const OutputFolder out(folder.file("used"));
    write_file(folder.file("used") + "/a", {});
  }
  std::filesystem::create_directory(folder.file("there"));
  { const OutputFolder out(folder.file("there")); }
  EXPECT_THAT(names_in(folder.file("")), ElementsAre("there", "used"));
}

TEST(WholeFile, DoesNotReplaceWhatIsNoFile) {
  EXPECT_THROW(WholeFile("/dev/null"), Error);
  EXPECT_THROW(WholeFile("/tmp"), Error);
}

TEST(ZipWriter, LeavesNothingUnlessItIsFinished) {
  const colored::Folder folder;
  { ZipWriter(folder.file("a.zip")).add("a", "text"); }
  EXPECT_THAT(names_in(folder.file("")), IsEmpty());
}

TEST(ZipWriter, KeepsNamesAndBytesInTheirOrder) {
  const colored::Folder folder;
  ZipWriter zip(folder.file("a.zip"));
  const std::string large(300000, 'x');
  zip.add("b/second", std::string_view());
  zip.add("a", large);
  zip.finish();
  const Archive archive(folder.file("a.zip"));
  ASSERT_EQ(archive.entries.size(), 2);
  EXPECT_EQ(archive.entries[0].name, "b/second");
  EXPECT_EQ(archive.entries[0].bytes, "");
  EXPECT_EQ(archive.entries[1].bytes, large);
  EXPECT_TRUE(archive.entries[1].stored);
}

}  // namespace
}  // namespace binderjet
