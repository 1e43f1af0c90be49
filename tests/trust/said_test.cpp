// SPDX-License-Identifier: GPL-3.0-or-later
// What the program says arrives, or its status says that it did not; and what files, names and
// devices are called is shown, not obeyed.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "tests/support/models.h"
#include "tests/support/program.h"

namespace binderjet {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::Not;

class Said : public testing::Test {
 protected:
  // The status of the program with these words in the shell, which may redirect.
  int shell(const std::string& words) const {
    const int status = std::system(
        ("cd '" + here_ / "" + "' && trap - INT && '" BINDERJET_PROGRAM "' " + words).c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  }
  // A small job.
  void slice(const std::string& model, const std::string& job = "a.bjob") const {
    std::ofstream(here_ / model) << box_obj();
    const Ran ran =
        here_.run({"slice", here_ / model, "-p", "z450", "--enhance", "none", "-o", here_ / job});
    ASSERT_EQ(ran.status, 0) << ran.err;
  }
  static std::string box_obj() {
    return "v 0 0 0\nv 4 0 0\nv 0 4 0\nv 0 0 4\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
  }

  const Workplace here_;
};

TEST_F(Said, ToAClosedOrFullStderrCostsNoStatus) {
  for (const char* where : {"2>&-", "2>/dev/full", "0<&- >&- 2>&-"}) {
    EXPECT_EQ(shell(std::string("slice none.obj -p z450 -o x.bjob ") + where), 3) << where;
    EXPECT_EQ(shell(std::string("nonsense ") + where), 2) << where;
  }
  // A warning too: the part is a tenth of a millimeter.
  std::ofstream(here_ / "small.obj")
      << "v 0 0 0\nv .1 0 0\nv 0 .1 0\nv 0 0 .1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
  EXPECT_EQ(shell("slice small.obj -p z450 --enhance none -o small.bjob 2>&-"), 0);
  EXPECT_TRUE(fs::exists(here_ / "small.bjob"));
}

TEST_F(Said, ToAFullStdoutIsAnError) {
  slice("a.obj");
  for (const char* words : {"score a.bjob --target a.obj --json", "score a.bjob --target a.obj",
                            "check a.obj -p z450", "profile list", "profile show z450", "--version",
                            "--help", "slice --help", "export a.bjob -o stack"}) {
    EXPECT_EQ(shell(std::string(words) + " >/dev/full 2>err.txt"), 5) << words;
    EXPECT_THAT(here_.text("err.txt"), HasSubstr("the result (standard output): cannot write"))
        << words;
  }
  EXPECT_EQ(shell("profile list >&- 2>err.txt"), 3);
  EXPECT_THAT(here_.text("err.txt"), HasSubstr("Bad file descriptor"));
}

// With stderr closed a file of ours would get its number, and our words.
TEST_F(Said, NeverIntoAFile) {
  slice("a.obj");
  std::ofstream(here_ / "small.obj")
      << "v 0 0 0\nv .1 0 0\nv 0 .1 0\nv 0 0 .1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
  EXPECT_EQ(shell("slice small.obj -p z450 --enhance none -o closed.bjob 0<&- 2>&-"), 0);
  EXPECT_EQ(shell("slice small.obj -p z450 --enhance none -o open.bjob -q 2>err.txt"), 0);
  EXPECT_EQ(here_.text("closed.bjob"), here_.text("open.bjob"));
}

TEST_F(Said, OfNamesThatAreNotUtf8InJsonByTheirBytes) {
  const std::string name =
      "gr\xf6\xdf"
      "e";
  slice(name + ".obj", name + ".bjob");
  const std::string job = here_ / (name + ".bjob");
  const std::string shown =
      "gr\\xf6\\xdf"
      "e";
  const Ran target =
      here_.run({"export", job, "--what", "target", "-o", here_ / "target", "--json"});
  EXPECT_EQ(target.status, 0) << "its model is found again: " << target.err;
  const Ran printed = here_.run({"print", job, "--to", "spool:" + here_ / "spool", "--json"});
  EXPECT_EQ(printed.status, 0) << printed.err;
  const Ran status = here_.run({"status", "--to", "spool:" + here_ / "spool", "--json"});
  ASSERT_EQ(status.status, 0) << status.err;
  EXPECT_THAT(status.json().dump(), HasSubstr("\\\\xf6"));
  const Ran score = here_.run({"score", job, "--target", here_ / (name + ".obj"), "--json"});
  EXPECT_EQ(score.status, 0) << score.err;
  EXPECT_FALSE(score.json().empty());
  const Ran simulate = here_.run({"simulate", job, "-p", "z450", "-o", here_ / name, "--json"});
  ASSERT_EQ(simulate.status, 0) << simulate.err;
  EXPECT_THAT(simulate.out, HasSubstr("xf6"));
  const Ran gone = here_.run({"slice", here_ / (name + "x.obj"), "-p", "z450", "-o", here_ / "x"});
  EXPECT_EQ(gone.status, 3);
  EXPECT_THAT(gone.err, HasSubstr(shown + "x.obj")) << "bytes are seen";
}

TEST_F(Said, OfNamesThatWouldCommandATerminal) {
  const std::string name = "a\x1b]0;owned\x07\nb";
  slice(name + ".obj", name + ".bjob");
  const std::string job = here_ / (name + ".bjob");
  ASSERT_EQ(here_.run({"print", job, "--to", "spool:" + here_ / "spool"}).status, 0);
  for (const std::vector<std::string>& words :
       {std::vector<std::string>{"status", "--to", "spool:" + here_ / "spool"},
        {"export", job, "-o", here_ / name},
        {"slice", here_ / (name + "gone.obj"), "-p", "z450", "-o", here_ / "x.bjob"},
        {"slice", here_ / (name + ".obj"), "-p", name, "-o", here_ / "x.bjob"},
        {name},
        {"status", "--to", name}}) {
    const Ran ran = here_.run(words);
    EXPECT_THAT(ran.out + ran.err, Not(HasSubstr("\x1b"))) << words.front();
    EXPECT_THAT(ran.out + ran.err, Not(HasSubstr("\x07"))) << words.front();
  }
}

}  // namespace
}  // namespace binderjet
