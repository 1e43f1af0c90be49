// SPDX-License-Identifier: GPL-3.0-or-later
// The portable folder needs nothing of the system that it runs on, and says whose all of it is.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <regex>

#include "tests/support/program.h"

namespace binderjet {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

// Packing copies 400 MB, so one test looks at all of it.
class Portable : public testing::Test {
 protected:
  void SetUp() override {
    fs::create_directory(root_);
    ASSERT_EQ(run("bash '" BINDERJET_SOURCE_DIR "/driver/package/portable.sh' '" BINDERJET_BUILD_DIR
                  "' '" +
                  folder_ + "'"),
              0)
        << said();
    for (const auto& entry : fs::directory_iterator(folder_ + "/lib")) {
      const std::string name = entry.path().filename();
      if (name.starts_with("ld-linux")) loader_ = "lib/" + name;
    }
  }

  // A line of the shell; its output is in said().
  int run(const std::string& line) const {
    return std::system(("{ " + line + "; } > '" + place_ / "said" + "' 2>&1").c_str());
  }
  std::string said() const { return place_.text("said"); }

  // Every verb of a small job, in tmp/, which lies at `tmp`.
  void run_job(const std::string& program, const std::string& profiles,
               const std::string& tmp) const {
    std::ofstream(tmp + "/part.ppm") << "P3 2 1 255  255 0 0  0 0 255";
    std::ofstream(tmp + "/part.mtl") << "newmtl skin\nmap_Kd part.ppm\n";
    std::ofstream(tmp + "/part.obj") << R"(mtllib part.mtl
v 0 0 0
v 4 0 0
v 0 4 0
v 0 0 4
vt 0 0
vt 1 0
vt 0 1
usemtl skin
f 1/1 3/3 2/2
f 1/1 2/2 4/3
f 1/1 4/3 3/2
f 2/1 3/2 4/3
)";
    for (const char* words :
         {"coupon --kind slots -o tmp/part.stl",
          "slice tmp/part.stl -p PROFILES/z450.toml --scale 0.2 --enhance paper -o tmp/job.bjob",
          "export tmp/job.bjob -o tmp/masks", "export tmp/job.bjob --html tmp/page.html",
          // With a picture, which a second program reads.
          "slice tmp/part.obj -p PROFILES/z450.toml --enhance none -o tmp/picture.bjob",
          "simulate tmp/job.bjob -p PROFILES/z450.toml -o tmp/printed",
          "score tmp/job.bjob --target tmp/part.stl",
          "print tmp/job.bjob --to file:tmp/sent.bjob"}) {
      const std::string line = std::regex_replace(words, std::regex("PROFILES"), profiles);
      ASSERT_EQ(run(program + " " + line), 0) << line << "\n" << said();
    }
  }

  const Workplace place_;
  const std::string root_ = place_ / "root";
  const std::string folder_ = root_ + "/a folder";
  std::string loader_ = "none";
};

TEST_F(Portable, NeedsNothingOfTheSystemAndSaysWhoseItIs) {
  // It starts through a link, without an environment, and finds its own profiles.
  fs::create_symlink(folder_ + "/bin/binderjet", place_ / "linked");
  ASSERT_EQ(run("cd / && env -i '" + place_ / "linked" + "' profile show z450 --json"), 0)
      << said();
  EXPECT_THAT(said(), HasSubstr(folder_ + "/share/binderjet/profiles/z450.toml"));

  // No library is the system's.
  int found = 0;
  for (const char* program : {"lib/binderjet", "lib/binderjet-read"}) {
    ASSERT_EQ(run("cd '" + folder_ + "' && " + loader_ +
                  " --inhibit-cache --library-path lib --list " + program),
              0)
        << said();
    std::istringstream libraries(said());
    for (std::string line; std::getline(libraries, line); ++found) {
      EXPECT_TRUE(line.find("linux-vdso") != line.npos || line.find("lib/") != line.npos) << line;
      EXPECT_EQ(line.find(" /"), line.npos) << line;
    }
  }
  EXPECT_GT(found, 50);

  // Each package among them has its license.
  const std::string terms = folder_ + "/share/doc/libraries/";
  std::ifstream sources(terms + "sources.txt");
  int packages = 0;
  for (std::string line; std::getline(sources, line); ++packages) {
    const std::string package = line.substr(0, line.find_first_of(": "));
    EXPECT_GT(fs::file_size(terms + package + ".txt"), 100U) << package;
  }
  EXPECT_GT(packages, 40);

  // Where there is nothing but the folder, /tmp and a shell, nobody gets the same bytes as here.
  if (geteuid() != 0) GTEST_SKIP() << "the rest needs the right to change the root";
  fs::rename(folder_, root_ + "/it");
  fs::create_directory(root_ + "/tmp");
  fs::permissions(root_ + "/tmp", fs::perms::all);
  fs::permissions(root_ + "/..", fs::perms(0755));
  fs::create_directory(root_ + "/bin");
  fs::copy("/bin/busybox", root_ + "/bin/sh");
  for (const char* tool : {"readlink", "dirname", "basename"}) {
    fs::create_symlink("sh", root_ + "/bin/" + tool);
  }
  run_job(
      "env -i PATH=/bin /usr/sbin/chroot --userspec=65534:65534 '" + root_ + "' /it/bin/binderjet",
      "/it/share/binderjet/profiles", root_ + "/tmp");
  fs::create_directories(place_ / "here/tmp");
  run_job("cd '" + place_ / "here" + "' && '" BINDERJET_PROGRAM "'",
          BINDERJET_SOURCE_DIR "/profiles", place_ / "here/tmp");
  EXPECT_EQ(run("diff -r '" + root_ + "/tmp' '" + place_ / "here/tmp" + "'"), 0) << said();
  EXPECT_TRUE(fs::exists(place_ / "here/tmp/masks/mask_000001.png"));
  EXPECT_EQ(run("strings -n 2 '" + place_ / "here/tmp/picture.bjob" + "' | grep -q color"), 0);
}

}  // namespace
}  // namespace binderjet
