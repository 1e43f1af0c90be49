// SPDX-License-Identifier: GPL-3.0-or-later
// Every verb at a terminal: long work is seen, and nothing of it stays on the screen.
#include "tests/support/terminal.h"

#include <CLI/CLI.hpp>
#include <regex>
#include <set>

#include "driver/verbs/program.h"
#include "tests/trust/writing_verbs.h"
#include "transport/job/job_file.h"
#include "transport/open/open_backend.h"

namespace binderjet::trust {
namespace {

using testing::Contains;
using testing::ContainsRegex;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

// Verbs that read or write one small thing, however large the part is; and emulator, which waits.
const std::set<std::string> kShort = {"coupon",  "status",  "cancel",
                                      "devices", "profile", "emulator"};

// What only writes to the disk stands in writing_verbs() already.
std::vector<Verb> long_verbs() {
  std::vector<Verb> verbs;
  for (const Verb& verb : writing_verbs()) {
    // Gauges are traced in one go, and then the stage has no length.
    if (!kShort.contains(verb.words.front()) && verb.name != "gauges") verbs.push_back(verb);
  }
  const std::vector<Verb> more = {
      {"check", {"check", "%IN/ball.obj", "-p", "z450"}},
      {"creases", {"slice", "%IN/ball.obj", "-p", "z450", "--color-enhance", "-o", "%OUT/a.bjob"}},
      {"score", {"score", "%IN/a.bjob", "--target", "%IN/ball.obj", "--compare"}},
      {"explain", {"explain", "%IN/a.bjob", "9,9,9"}},
      {"several",
       {"export", "%IN/a.bjob", "-o", "%OUT/all", "--what", "mask,color,target,printed", "--html",
        "%OUT/a.html", "--zip", "%OUT/a.zip"}},
      {"scan",
       {"calibrate", "-p", "z450", "--job", "%IN/masks", "--measured", "%IN/small.obj", "-o",
        "%OUT/out"}},
      {"resume", {"resume", "1", "--to", "spool:%OUT", "--job", "%IN/a.bjob"}}};
  verbs.insert(verbs.end(), more.begin(), more.end());
  return verbs;
}

class Terminal : public WritingVerbs {
 protected:
  // The words with inputs and a new folder; what the verb needs in the folder is put there.
  std::vector<std::string> ready(const Verb& verb, const std::string& name) const {
    const std::string out = folder(name);
    if (verb.name == "resume") hold_a_job("spool:" + out);
    return words(verb, out);
  }

 private:
  // A job whose sender stopped after its first layers.
  void hold_a_job(const std::string& uri) const {
    const JobReader job = *JobReader::open(place_ / "a.bjob");
    const auto spool = *open_backend(uri);
    const int layers = static_cast<int>(job.layers(RecordKind::kMask).size());
    ASSERT_TRUE(spool->start({job.header(), layers, "a", ""}));
    for (int layer = 0; layer < 3; ++layer) {
      std::vector<std::byte> records = *job.read_record(RecordKind::kMask, layer);
      const std::vector<std::byte> color = *job.read_record(RecordKind::kColor, layer);
      records.insert(records.end(), color.begin(), color.end());
      ASSERT_TRUE(spool->send(layer, records));
    }
  }
};

TEST_F(Terminal, IsTriedWithEveryVerbOfTheProgram) {
  std::set<std::string> tried = kShort;
  for (const Verb& verb : long_verbs()) tried.insert(verb.words.front());
  std::set<std::string> all;
  const auto program = make_program();
  for (const CLI::App* verb : program->get_subcommands({})) all.insert(verb->get_name());
  EXPECT_EQ(tried, all);
}

TEST_F(Terminal, ShowsWhatHowFarHowFastAndHowLongStillInEveryLongVerb) {
  for (const Verb& verb : long_verbs()) {
    SCOPED_TRACE(verb.name);
    const AtTerminal ran = run_at_terminal(ready(verb, "seen-" + verb.name));
    ASSERT_EQ(ran.status, 0) << ran.written;
    EXPECT_THAT(ran.painted(),
                Contains(ContainsRegex("^[a-z][a-z :()]+ \\[#+ *\\] [0-9]+/[0-9]+ [a-z]+, "
                                       "[0-9.]+/s, [0-9]+:[0-9][0-9] left$")));
    for (const std::string& line : ran.screen()) {
      EXPECT_THAT(line, Not(ContainsRegex("\\[#* *\\]|/s,|, [0-9]+:[0-9][0-9]$")));
    }
  }
}

TEST_F(Terminal, OfFewColumnsIsNeverWrittenBeyondItsEdge) {
  constexpr int kColumns = 24;
  const AtTerminal ran =
      run_at_terminal({"score", place_ / "a.bjob", "--target", place_ / "ball.obj"}, kColumns);
  ASSERT_EQ(ran.status, 0) << ran.written;
  EXPECT_THAT(ran.painted(), Not(IsEmpty()));
  for (const std::string& text : ran.painted()) EXPECT_LT(text.size(), std::size_t{kColumns});
}

TEST_F(Terminal, StaysSilentWithQuietAndSoDoesAFile) {
  for (const Verb& verb : long_verbs()) {
    SCOPED_TRACE(verb.name);
    std::vector<std::string> quiet = ready(verb, "quiet-" + verb.name);
    quiet.emplace_back("-q");
    const AtTerminal ran = run_at_terminal(quiet);
    ASSERT_EQ(ran.status, 0) << ran.written;
    EXPECT_THAT(ran.written, Not(HasSubstr("\033")));
    const Ran to_a_file = place_.run(ready(verb, "file-" + verb.name));
    ASSERT_EQ(to_a_file.status, 0) << to_a_file.err;
    EXPECT_THAT(to_a_file.err + to_a_file.out, Not(HasSubstr("\r")));
  }
}

// What is found on the way begins a line of its own.
TEST_F(Terminal, MakesRoomForWhatIsSaidMeanwhile) {
  const AtTerminal ran = run_at_terminal({"calibrate", "-p", "z450", "--job", place_ / "masks",
                                          "--measured", place_ / "print", "-o", place_ / "out"});
  ASSERT_EQ(ran.status, 0) << ran.written;
  EXPECT_THAT(ran.screen(), Contains("looking for effect 1"));
  EXPECT_THAT(ran.screen(), Contains(testing::StartsWith("best is ")));
}

TEST_F(Terminal, IsCleanAfterAnError) {
  const AtTerminal ran = run_at_terminal(
      {"export", place_ / "a.bjob", "--zip", place_ / "a.zip", "--html", "/nowhere/at/all.html"});
  EXPECT_EQ(ran.status, 3) << ran.written;
  EXPECT_THAT(ran.painted(), Not(IsEmpty()));
  EXPECT_THAT(ran.screen(), Contains(testing::StartsWith("binderjet: /nowhere/at/all.html")));
}

}  // namespace
}  // namespace binderjet::trust
