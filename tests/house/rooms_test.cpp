// SPDX-License-Identifier: GPL-3.0-or-later
// What is against the rule is reported with its file and line: on small trees made up here.
#include "tests/house/rooms.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "tests/support/program.h"

namespace binderjet::house {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

// A tree whose rooms are slicer/base, slicer/layers above it, and driver/verbs on top.
class Rooms : public testing::Test {
 protected:
  Rooms() {
    put("slicer/base/error.h", "#pragma once\n");
    put("slicer/layers/rows.h",
        "#pragma once\n#include <vector>\n#include \"slicer/base/error.h\"\n");
    put("driver/verbs/verbs.cpp", "#include \"slicer/layers/rows.h\"\n");
    lines_ = "slicer/base: \nslicer/layers: slicer/base\ndriver/verbs: slicer/*\n";
  }
  void put(const std::string& path, const std::string& text) {
    const std::filesystem::path file = root_ / path;
    std::filesystem::create_directories(file.parent_path());
    std::ofstream(file) << text;
  }
  std::vector<Room> rooms() const {
    std::istringstream text(lines_);
    return read_rooms(text);
  }
  std::vector<File> tree() const { return read_tree(root_ / "", rooms()); }

  Workplace root_;
  std::string lines_;
};

TEST_F(Rooms, AreRightWhereEveryArrowPointsDownwards) {
  EXPECT_THAT(includes_against_the_rule(tree(), rooms()), IsEmpty());
  EXPECT_THAT(cycles(tree(), rooms()), IsEmpty());
  EXPECT_THAT(strays(tree(), rooms()), IsEmpty());
  EXPECT_THAT(idle_uses(tree(), rooms()), IsEmpty());
}

TEST_F(Rooms, DoNotIncludeWhatTheirLineDoesNotUse) {
  put("slicer/base/error.h", "#pragma once\n\n#  include \"slicer/layers/rows.h\"\n");
  EXPECT_THAT(
      includes_against_the_rule(tree(), rooms()),
      ElementsAre("slicer/base/error.h:3: slicer/base may not include slicer/layers/rows.h: "
                  "its line in slicer/CMakeLists.txt does not use slicer/layers"));
}

TEST_F(Rooms, DoNotHideAnIncludeInAngleBrackets) {
  put("slicer/base/error.h", "#include <driver/verbs/verbs.cpp>\n");
  EXPECT_THAT(
      includes_against_the_rule(tree(), rooms()),
      ElementsAre("slicer/base/error.h:1: slicer/base may not include driver/verbs/verbs.cpp: its "
                  "line in slicer/CMakeLists.txt does not use driver/verbs"));
}

TEST_F(Rooms, WriteAPathFromTheRootAndIncludeNoTest) {
  put("slicer/layers/rows.h", "#include \"../base/error.h\"\n#include \"tests/house/rooms.h\"\n");
  EXPECT_THAT(
      includes_against_the_rule(tree(), rooms()),
      ElementsAre("slicer/layers/rows.h:1: ../base/error.h is no file of a room; a path is "
                  "written from the root of the tree",
                  "slicer/layers/rows.h:2: tests/house/rooms.h is no file of a room; a path "
                  "is written from the root of the tree"));
}

TEST_F(Rooms, StandInNoCycleOfIncludes) {
  // The line allows both arrows, so that the cycle alone is wrong.
  lines_ = "slicer/base: slicer/layers\nslicer/layers: slicer/base\ndriver/verbs: slicer/*\n";
  put("slicer/base/error.cpp", "\n#include \"slicer/layers/rows.h\"\n");
  EXPECT_THAT(includes_against_the_rule(tree(), rooms()), IsEmpty());
  EXPECT_THAT(cycles(tree(), rooms()),
              ElementsAre("slicer/base/error.cpp:2: slicer/base includes slicer/layers/rows.h, and",
                          "slicer/layers/rows.h:3: slicer/layers includes slicer/base/error.h, "
                          "which closes a cycle of rooms"));
}

TEST_F(Rooms, StandInNoCycleOfLinesThatNoIncludeNeeds) {
  lines_ = "slicer/base: slicer/layers\nslicer/layers: slicer/base\ndriver/verbs: slicer/*\n";
  EXPECT_THAT(cycles(tree(), rooms()),
              ElementsAre("slicer/CMakeLists.txt: slicer/base uses slicer/layers, and",
                          "slicer/layers/rows.h:3: slicer/layers includes slicer/base/error.h, "
                          "which closes a cycle of rooms"));
}

TEST_F(Rooms, HoldEveryFile) {
  put("slicer/README.md", "");
  put("driver/main.cpp", "");
  lines_ += "driver: driver/verbs\n";
  EXPECT_THAT(strays(tree(), rooms()), IsEmpty());
  put("slicer/loose.h", "");
  put("slicer/attic/forgotten.cpp", "");
  EXPECT_THAT(strays(tree(), rooms()),
              ElementsAre("slicer/attic/forgotten.cpp:1: in no room: slicer/attic has no line in "
                          "slicer/CMakeLists.txt",
                          "slicer/loose.h:1: a loose file in slicer/: put it into a room"));
}

TEST_F(Rooms, ListNoRoomThatTheyDoNotInclude) {
  put("driver/verbs/verbs.cpp", "");
  EXPECT_THAT(idle_uses(tree(), rooms()),
              ElementsAre("driver/CMakeLists.txt: driver/verbs uses slicer/*, of which no file of "
                          "it includes anything"));
}

TEST_F(Rooms, AreNotCrowded) {
  put("slicer/base/README.md", "");
  EXPECT_THAT(crowded_rooms(tree(), rooms(), 1), IsEmpty());
  put("slicer/base/error.cpp", "");
  EXPECT_THAT(crowded_rooms(tree(), rooms(), 1), ElementsAre("slicer/base has 2 files"));
}

}  // namespace
}  // namespace binderjet::house
