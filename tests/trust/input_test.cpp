// SPDX-License-Identifier: GPL-3.0-or-later
// Inputs that change, shrink or vanish while they are read: one line and status 3, or a result.
#include <atomic>
#include <chrono>
#include <random>
#include <thread>

#include "tests/trust/writing_verbs.h"

namespace binderjet::trust {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

// Does something to a file again and again, as long as it lives.
class Meddler {
 public:
  template <class Meddle>
  explicit Meddler(Meddle meddle)
      : thread_([this, meddle] {
          while (!stop_) {
            meddle();
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
          }
        }) {}
  ~Meddler() {
    stop_ = true;
    thread_.join();
  }
  Meddler(const Meddler&) = delete;
  Meddler& operator=(const Meddler&) = delete;

 private:
  std::atomic<bool> stop_ = false;
  std::thread thread_;
};

class ChangingInput : public WritingVerbs {
 protected:
  // Runs the verb of this name again and again while `path` is cut at random and made whole.
  void run_meanwhile(const std::string& name, const std::string& path, int runs) {
    const std::string bytes = read(path);
    const unsigned seed = std::random_device()();
    std::cout << "seed " << seed << '\n';
    std::mt19937 random(seed);
    const Meddler meddler([&] {
      std::error_code error;
      std::filesystem::resize_file(path, random() % (bytes.size() + 1), error);
      std::ofstream(path, std::ios::binary) << bytes;
    });
    const std::vector<Verb> verbs = writing_verbs();
    const auto verb =
        std::find_if(verbs.begin(), verbs.end(), [&](const Verb& v) { return v.name == name; });
    for (int run = 0; run < runs; ++run) {
      const std::string out = folder(name + std::to_string(run));
      const Ran ran = place_.run(words(*verb, out));
      if (ran.status == 0) continue;
      EXPECT_EQ(ran.status, 3) << ran.err;
      EXPECT_EQ(error_lines(ran.err), 1) << ran.err;
      EXPECT_THAT(left_behind(out), IsEmpty());
    }
  }
  static std::string read(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }
};

TEST_F(ChangingInput, OfAModelIsNoticed) { run_meanwhile("slice", place_ / "ball.obj", 5); }

TEST_F(ChangingInput, OfAJobIsNoticed) {
  run_meanwhile("masks", place_ / "a.bjob", 3);
  run_meanwhile("zip", place_ / "a.bjob", 3);
}

TEST_F(ChangingInput, OfAShareIsNoticed) { run_meanwhile("join", place_ / "low.bjob", 4); }

TEST_F(ChangingInput, OfAStacksImageIsNoticed) {
  run_meanwhile("calibrate", place_ / "print/printed_000004.png", 3);
}

TEST_F(ChangingInput, OfAJobsModelIsNoticedWhenItsTargetIsExported) {
  std::ofstream(place_ / "ball.obj", std::ios::app) << "# another\n";
  const Ran ran =
      place_.run({"export", place_ / "a.bjob", "-o", place_ / "target", "--what", "target"});
  EXPECT_EQ(ran.status, 3);
  EXPECT_EQ(error_lines(ran.err), 1) << ran.err;
  EXPECT_THAT(ran.err, HasSubstr("ball.obj"));
}

TEST_F(ChangingInput, ThatVanishesIsNamed) {
  for (const Verb& verb : writing_verbs()) {
    SCOPED_TRACE(verb.name);
    if (verb.name == "coupon") continue;  // reads nothing
    std::vector<std::string> gone = words(verb, folder("gone"));
    for (std::string& word : gone) {
      const std::size_t extension = word.rfind('.');
      if (word.find("/./") != std::string::npos) {
        word.insert(
            extension == std::string::npos || word[extension + 1] == '/' ? word.size() : extension,
            "-gone");
      }
    }
    const Ran ran = place_.run(gone);
    EXPECT_EQ(ran.status, 3) << ran.err;
    EXPECT_EQ(error_lines(ran.err), 1) << ran.err;
    EXPECT_THAT(ran.err, HasSubstr("-gone"));
  }
}

}  // namespace
}  // namespace binderjet::trust
