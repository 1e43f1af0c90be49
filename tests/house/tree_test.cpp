// SPDX-License-Identifier: GPL-3.0-or-later
// The tree that this test was built from keeps to the rule of its rooms, and the tests mirror it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "tests/house/rooms.h"

namespace binderjet::house {
namespace {

namespace fs = std::filesystem;
using testing::IsEmpty;

const fs::path kRoot = BINDERJET_SOURCE_DIR;

class Tree : public testing::Test {
 protected:
  Tree() {
    std::ifstream text(BINDERJET_BUILD_DIR "/rooms.txt");
    rooms_ = read_rooms(text);
    tree_ = read_tree(kRoot, rooms_);
  }
  std::vector<Room> rooms_;
  std::vector<File> tree_;
};

TEST_F(Tree, HasRoomsAndFiles) {
  EXPECT_GT(rooms_.size(), 30U);
  EXPECT_GT(tree_.size(), 300U);
}

TEST_F(Tree, IncludesNothingAgainstTheRule) {
  EXPECT_THAT(includes_against_the_rule(tree_, rooms_), IsEmpty());
}

TEST_F(Tree, HasNoCycleOfRooms) { EXPECT_THAT(cycles(tree_, rooms_), IsEmpty()); }

TEST_F(Tree, HasNoFileOutsideOfARoom) { EXPECT_THAT(strays(tree_, rooms_), IsEmpty()); }

TEST_F(Tree, HasNoLineThatUsesMoreThanItsRoomIncludes) {
  EXPECT_THAT(idle_uses(tree_, rooms_), IsEmpty());
}

// As many as a reader looks over at once. The effects have a file each, which their names tell.
TEST_F(Tree, HasNoRoomOfMoreThanThirtyFiles) {
  std::vector<Room> rooms;
  for (const Room& room : rooms_) {
    if (room.name != "slicer/model/effects") rooms.push_back(room);
  }
  EXPECT_THAT(crowded_rooms(tree_, rooms, 30), IsEmpty());
}

TEST_F(Tree, IsMirroredByTheTests) {
  std::vector<std::string> without;
  for (const std::string top : {"slicer", "driver", "transport"}) {
    for (const auto& entry : fs::recursive_directory_iterator(kRoot / "tests" / top)) {
      const fs::path folder = entry.path().parent_path().lexically_relative(kRoot / "tests");
      if (entry.is_regular_file() && !fs::is_directory(kRoot / folder)) {
        without.push_back(entry.path().lexically_relative(kRoot).string() +
                          ":1: there is no folder " + folder.string());
      }
    }
  }
  EXPECT_THAT(without, IsEmpty());
}

}  // namespace
}  // namespace binderjet::house
