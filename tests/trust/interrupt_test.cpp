// SPDX-License-Identifier: GPL-3.0-or-later
// Ctrl-C at any moment of every verb that writes: status 130, and nothing half-written. A slice
// goes on where it was.
#include <gmock/gmock.h>
#include <sys/stat.h>

#include <csignal>
#include <random>
#include <thread>

#include "tests/trust/writing_verbs.h"

namespace binderjet::trust {
namespace {

using testing::IsEmpty;

class Interrupted : public WritingVerbs {};

TEST_F(Interrupted, EndsEveryVerbWith130OrItsWholeResult) {
  const unsigned seed = std::random_device()();
  std::cout << "seed " << seed << '\n';
  std::mt19937 random(seed);
  int ended = 0;
  for (const Verb& verb : writing_verbs()) {
    SCOPED_TRACE(verb.name);
    const Ran unhindered = place_.run(words(verb, folder("whole-" + verb.name)));
    ASSERT_EQ(unhindered.status, 0) << unhindered.err;
    for (int trial = 0; trial < 2; ++trial) {
      const std::chrono::duration<double> moment(
          std::uniform_real_distribution(0.0, unhindered.seconds)(random));
      SCOPED_TRACE(moment.count());
      const std::string out = folder("out-" + verb.name + std::to_string(trial));
      const Ran ran = place_.run(words(verb, out), 600, 0, [&](pid_t program) {
        std::this_thread::sleep_for(moment);
        kill(program, SIGINT);
      });
      if (ran.status == 0) continue;  // it was done before
      ++ended;
      EXPECT_EQ(ran.status, 130) << ran.err;
      EXPECT_LE(error_lines(ran.err), 1) << ran.err;
      EXPECT_THAT(left_behind(out), IsEmpty());
      if (verb.words.front() != "slice") continue;
      EXPECT_EQ(place_.run(words(verb, out)).status, 0);
      const auto job = [](const std::string& folder) {
        return std::filesystem::path(folder).filename().string() + "/a.bjob";
      };
      EXPECT_EQ(place_.text(job(out)), place_.text(job(folder("whole-" + verb.name))));
      EXPECT_EQ(std::distance(std::filesystem::directory_iterator(out), {}), 1);
    }
  }
  EXPECT_GT(ended, 10);
}

// A call that waits for ever in a thread that no signal reaches, in the middle of writing.
TEST_F(Interrupted, EndsWhatDoesNotHearIt) {
  std::ofstream(place_ / "reader") << "#!/bin/sh\necho >> " << place_ / "asked"
                                   << "\nexec cat > /dev/null\n";
  ::chmod((place_ / "reader").c_str(), 0755);
  ::setenv("BINDERJET_READ", (place_ / "reader").c_str(), 1);
  std::filesystem::create_directory(place_ / "odd");
  std::ofstream(place_ / "odd/stack.json")
      << R"({"format": "slice-stack", "version": 1, "kind": "mask", "size": [8, 8, 2],)"
      << R"("pitch_mm": [0.1, 0.1, 0.1], "origin_mm": [0, 0, 0], "files": "m%d.bmp", "first": 0})";
  for (const char* name : {"odd/m0.bmp", "odd/m1.bmp"}) std::ofstream(place_ / name) << "BM";
  place_.wall_seconds = 60;
  const std::string out = folder("never");
  const Ran ran = place_.run({"simulate", place_ / "odd", "-p", "z450", "-o", out + "/printed"},
                             600, 0, [&](pid_t program) {
                               while (!std::filesystem::exists(place_ / "asked")) {
                                 std::this_thread::sleep_for(std::chrono::milliseconds(5));
                               }
                               kill(program, SIGINT);
                             });
  ::unsetenv("BINDERJET_READ");
  EXPECT_EQ(ran.status, 130) << ran.err;
  EXPECT_THAT(ran.err, testing::HasSubstr("stopping; once more ends at once"));
  EXPECT_THAT(ran.err, testing::HasSubstr("interrupted"));
  EXPECT_EQ(std::filesystem::is_empty(out), true);
}

}  // namespace
}  // namespace binderjet::trust
