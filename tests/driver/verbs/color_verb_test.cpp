// SPDX-License-Identifier: GPL-3.0-or-later
// Color through the program: sliced, joined from shares, exported, separated.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <string>

#include "slicer/base/whole_file.h"
#include "slicer/stack/png.h"
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

// A ball whose points have one color below its middle and another above.
std::string colored_ball(const colored::Folder& folder, const std::string& name = "ball.obj",
                         const std::string& below = "1 0 0", const std::string& above = "0 0 1") {
  const Mesh ball = models::sphere(2, 3);
  std::string text;
  for (const Point& p : ball.points) {
    text += fmt::format("v {} {} {} {}\n", p[0], p[1], p[2], p[2] < 0 ? below : above);
  }
  for (const Triangle& t : ball.triangles) {
    text += fmt::format("f {} {} {}\n", t[0] + 1, t[1] + 1, t[2] + 1);
  }
  return folder.write(name, text);
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

TEST(ColorVerbs, EachPartOfABedKeepsItsOwnColor) {
  const colored::Folder folder;
  ASSERT_EQ(run("slice " + colored_ball(folder, "red.obj", "1 0 0", "1 0 0") + " " +
                colored_ball(folder, "blue.obj", "0 0 1", "0 0 1") +
                " --at 10,10 --at 20,10 -p z450 --enhance none -o " + folder.file("two.bjob")),
            0);
  ASSERT_EQ(
      run("export " + folder.file("two.bjob") + " -o " + folder.file("planes") + " --separate cmy"),
      0);
  const StackReader cyan(folder.file("planes/cyan"));  // blue is cyan and magenta
  const StackReader yellow(folder.file("planes/yellow"));
  const int middle = cyan.info().size[0] / 2;
  int drops = 0;
  for (int k = 0; k < cyan.info().size[2]; ++k) {
    const auto blue = cyan.read(k);
    const auto red = yellow.read(k);
    for (int y = 0; y < cyan.info().size[1]; ++y) {
      for (int x = 0; x < cyan.info().size[0]; ++x) {
        drops += blue.at(x, y) || red.at(x, y) ? 1 : 0;
        ASSERT_FALSE(x < middle ? blue.at(x, y) : red.at(x, y)) << x << ", " << y << ", " << k;
      }
    }
  }
  EXPECT_GT(drops, 10000);
}

TEST(ColorVerbs, AnImageMayBeGivenToAModelThatNamesNone) {
  const colored::Folder folder;
  const Mesh box = models::box({0, 0, 0}, {3, 3, 1});
  std::string text = "vt 0.5 0.5\n";
  for (const Point& p : box.points) text += fmt::format("v {} {} {}\n", p[0], p[1], p[2]);
  for (const Triangle& t : box.triangles) {
    text += fmt::format("f {}/1 {}/1 {}/1\n", t[0] + 1, t[1] + 1, t[2] + 1);
  }
  const std::vector<std::byte> blue = {std::byte{0}, std::byte{0}, std::byte{255}};
  write_file(folder.file("blue.png"), encode_png_rgb(blue, 1, 1, {1, 1}));
  const std::string slice = "slice " + folder.write("box.obj", text) +
                            " -p z450 --enhance none -o " + folder.file("box.bjob") + " --texture ";
  EXPECT_EQ(run(slice + folder.file("absent.png")), 2);
  ASSERT_EQ(run(slice + folder.file("blue.png")), 0);
  ASSERT_EQ(
      run("export " + folder.file("box.bjob") + " -o " + folder.file("planes") + " --separate cmy"),
      0);
  EXPECT_GT(StackReader(folder.file("planes/cyan")).read(2).count(), 0);
  EXPECT_EQ(StackReader(folder.file("planes/yellow")).read(2).count(), 0);
  models::write_obj(box, folder.file("plain.obj"));
  EXPECT_EQ(run("slice " + folder.file("plain.obj") + " -p z450 --enhance none -o " +
                folder.file("plain.bjob") + " --texture " + folder.file("blue.png")),
            2)
      << "it says nowhere what of the image belongs where";
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
