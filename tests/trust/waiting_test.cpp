// SPDX-License-Identifier: GPL-3.0-or-later
// What would wait for ever is refused at once, or hears Ctrl-C.
#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <thread>

#include "tests/support/program.h"

namespace binderjet {
namespace {

namespace fs = std::filesystem;
using testing::AnyOf;
using testing::HasSubstr;

constexpr const char* kPart =
    "v 0 0 0\nv 4 0 0\nv 0 4 0\nv 0 0 4\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";

class Waiting : public testing::Test {
 protected:
  Waiting() {
    here_.wall_seconds = 60;  // who waits, waits for ever
    std::ofstream(here_ / "part.obj") << kPart;
    const Ran ran = here_.run(
        {"slice", here_ / "part.obj", "-p", "z450", "--enhance", "none", "-o", here_ / "a.bjob"});
    EXPECT_EQ(ran.status, 0) << ran.err;
  }
  Ran run(const std::vector<std::string>& words) const { return here_.run(words, 10); }

  Workplace here_;
};

TEST_F(Waiting, ForAFifoOrADeviceIsRefused) {
  for (const bool fifo : {true, false}) {
    const auto odd = [&](const std::string& name) {
      const std::string path = here_ / name;
      fs::create_directories(fs::path(path).parent_path());
      fs::remove(path);
      if (fifo) {
        mkfifo(path.c_str(), 0600);
      } else {
        fs::create_symlink("/dev/zero", path);
      }
      return path;
    };
    const std::string stack = fs::path(odd("stack/stack.json")).parent_path();
    for (const char* name :
         {"m.obj", "m.stl", "m.ply", "m.off", "m.3mf", "m.wrl", "m.glb", "m.dae"}) {
      const std::string model = odd(name);
      for (const std::vector<std::string>& words :
           {std::vector<std::string>{"slice", model, "-p", "z450", "-o", here_ / "x.bjob"},
            {"check", model, "-p", "z450"},
            {"score", here_ / "a.bjob", "--target", model}}) {
        const Ran ran = run(words);
        EXPECT_EQ(ran.status, 3) << words.front() << " " << name << ": " << ran.err;
        EXPECT_THAT(ran.err, HasSubstr("plain file")) << words.front() << " " << name;
      }
    }
    const std::string job = odd("odd.bjob");
    for (const std::vector<std::string>& words :
         {std::vector<std::string>{"export", job, "-o", here_ / "out"},
          {"export", stack, "-o", here_ / "out"},
          {"print", job, "--to", "file:" + here_ / "x.bjob"},
          {"score", job, "--target", here_ / "part.obj"},
          {"simulate", job, "-p", "z450", "-o", here_ / "out"},
          {"calibrate", "-p", "z450", "--job", here_ / "a.bjob", "--measured", stack, "-o",
           here_ / "out"},
          {"calibrate", "-p", "z450", "--gauges", odd("slots.csv"), "-o", here_ / "out"},
          {"slice", here_ / "part.obj", "-p", odd("p.toml"), "-o", here_ / "x.bjob"}}) {
      const Ran ran = run(words);
      EXPECT_THAT(ran.status, AnyOf(2, 3)) << words.front() << ": " << ran.err;
    }
  }
}

// The line of /proc/locks of who waits for a lock.
bool waits_for_a_lock(pid_t program) {
  std::ifstream locks("/proc/locks");
  for (std::string line; std::getline(locks, line);) {
    if (line.find("->") != line.npos &&
        line.find(" " + std::to_string(program) + " ") != line.npos) {
      return true;
    }
  }
  return false;
}

TEST_F(Waiting, ForTheSpoolsLockHearsASignal) {
  const std::string spool = "spool:" + here_ / "spool";
  ASSERT_EQ(here_.run({"print", here_ / "a.bjob", "--to", spool}).status, 0);
  const int lock = ::open((here_ / "spool/last-id").c_str(), O_RDWR | O_CLOEXEC);
  ASSERT_EQ(flock(lock, LOCK_EX), 0);
  const std::vector<std::pair<int, std::vector<std::string>>> cases = {
      {SIGINT, {"status", "--to", spool}},
      {SIGTERM, {"print", here_ / "a.bjob", "--to", spool}},
      {SIGHUP, {"cancel", "1", "--to", spool}}};
  for (const auto& [signal, words] : cases) {
    const Ran ran = here_.run(words, 10, 0, [&, signal = signal](pid_t program) {
      for (int tries = 0; tries < 6000 && !waits_for_a_lock(program); ++tries) {
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
      }
      kill(program, signal);
    });
    EXPECT_EQ(ran.status, 130) << words.front() << ": " << ran.err;
    EXPECT_THAT(ran.err, HasSubstr("waits for another process")) << words.front();
    EXPECT_THAT(ran.err, HasSubstr("interrupted")) << words.front();
  }
  ::close(lock);
}

}  // namespace
}  // namespace binderjet
