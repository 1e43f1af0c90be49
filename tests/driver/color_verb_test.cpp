// SPDX-License-Identifier: GPL-3.0-or-later
// Color through the program: sliced, joined from shares, exported, separated.
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <string>

#include "slicer/stack/slice_stack.h"
#include "tests/slicer/color/colored_layers.h"

namespace binderjet {
namespace {

int run(const std::string& arguments) {
  const int status = std::system((BINDERJET_PROGRAM " " + arguments + " -q 2>/dev/null").c_str());
  return WEXITSTATUS(status);
}

std::string bytes(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

// A ball whose points are red below and blue above.
std::string colored_ball(const colored::Folder& folder) {
  const Mesh ball = models::sphere(2, 3);
  std::string text;
  for (const Point& p : ball.points) {
    text += "v " + std::to_string(p[0]) + " " + std::to_string(p[1]) + " " + std::to_string(p[2]) +
            (p[2] < 0 ? " 1 0 0\n" : " 0 0 1\n");
  }
  for (const Triangle& t : ball.triangles) {
    text += "f " + std::to_string(t[0] + 1) + " " + std::to_string(t[1] + 1) + " " +
            std::to_string(t[2] + 1) + "\n";
  }
  return folder.write("ball.obj", text);
}

TEST(ColorVerbs, SharesJoinToTheWholeJobWithItsColor) {
  const colored::Folder folder;
  const std::string slice = "slice " + colored_ball(folder) + " -p z450 --enhance paper -o ";
  ASSERT_EQ(run(slice + folder.file("whole.bjob")), 0);
  ASSERT_EQ(run(slice + folder.file("a.bjob") + " --layers :17"), 0);
  ASSERT_EQ(run(slice + folder.file("b.bjob") + " --layers 17:"), 0);
  ASSERT_EQ(run("join " + folder.file("a.bjob") + " " + folder.file("b.bjob") + " -o " +
                folder.file("joined.bjob")),
            0);
  EXPECT_EQ(bytes(folder.file("joined.bjob")), bytes(folder.file("whole.bjob")));
}

TEST(ColorVerbs, ExportWritesBitmapsAndPlanes) {
  const colored::Folder folder;
  ASSERT_EQ(run("slice " + colored_ball(folder) + " -p z450 --enhance none -o " +
                folder.file("ball.bjob")),
            0);
  ASSERT_EQ(
      run("export " + folder.file("ball.bjob") + " -o " + folder.file("color") + " --what color"),
      0);
  EXPECT_EQ(StackReader(folder.file("color")).info().kind, StackKind::kColor);
  ASSERT_EQ(run("export " + folder.file("ball.bjob") + " -o " + folder.file("planes") +
                " --separate cmy"),
            0);
  // Red is magenta and yellow; blue is cyan and magenta.
  const auto drops = [&](const std::string& ink, int layer) {
    return StackReader(folder.file("planes/" + ink)).read(layer).count();
  };
  const int top = StackReader(folder.file("planes/cyan")).info().size[2] - 1;
  EXPECT_EQ(drops("cyan", 1), 0);
  EXPECT_GT(drops("magenta", 1), 0);
  EXPECT_GT(drops("yellow", 1), 0);
  EXPECT_GT(drops("cyan", top - 1), 0);
  EXPECT_EQ(drops("yellow", top - 1), 0);
}

TEST(ColorVerbs, AJobWithoutColorSaysSo) {
  const colored::Folder folder;
  models::write_obj(models::sphere(2, 3), folder.file("plain.obj"));
  ASSERT_EQ(run("slice " + folder.file("plain.obj") + " -p z450 --enhance none -o " +
                folder.file("p.bjob")),
            0);
  EXPECT_EQ(run("export " + folder.file("p.bjob") + " -o " + folder.file("c") + " --what color"),
            2);
  EXPECT_EQ(run("slice " + folder.file("plain.obj") + " -p z450 --enhance none -o " +
                folder.file("q.bjob") + " --color-enhance"),
            0);
  EXPECT_EQ(run("export " + folder.file("q.bjob") + " -o " + folder.file("c") + " --what color"),
            0);
}

}  // namespace
}  // namespace binderjet
