// SPDX-License-Identifier: GPL-3.0-or-later
// Ctrl-C at any moment of every verb that writes: status 130, and nothing half-written.
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
    }
  }
  EXPECT_GT(ended, 10);
}

}  // namespace
}  // namespace binderjet::trust
