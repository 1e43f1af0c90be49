// SPDX-License-Identifier: GPL-3.0-or-later
// A printer for people without one: the program plays it, and the same program prints to it, as a
// user without rights and without a home.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <nlohmann/json.hpp>

#include "driver/emulator/printed_volume.h"
#include "slicer/stack/slice_stack.h"
#include "tests/support/started_program.h"
#include "tests/transport/sample_job.h"

namespace binderjet {
namespace {

using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

// Within 2 s alone on a machine; who waits out a patience takes 30.
constexpr double kAtOnce = 10;

class EmulatorVerb : public testing::Test {
 protected:
  EmulatorVerb() {
    chmod(folder_.path().c_str(), 0777);
    unsetenv("HOME");
    unsetenv("XDG_STATE_HOME");
    unsetenv("BINDERJET_STATE");
    write_job(job_, kPrintLayers);
  }

  static void write_job(const std::string& path, int layers) {
    auto writer = JobWriter::create(
        path, R"({"format": "job", "size_px": [64, 64, )" + std::to_string(layers) + "]}");
    for (int layer = 0; layer < layers; ++layer) {
      ASSERT_TRUE(writer->append(print_records(layer)));
    }
    ASSERT_TRUE(writer->finish());
    chmod(path.c_str(), 0644);
  }
  Ended run(const std::vector<std::string>& words) { return Started(words, true).end(); }
  // The emulator, once it is ready.
  std::unique_ptr<Started> play(const std::vector<std::string>& more = {}) {
    std::vector<std::string> words = {"emulator", "-o", printer_, "--json"};
    words.insert(words.end(), more.begin(), more.end());
    auto emulator = std::make_unique<Started>(words, true);
    EXPECT_THAT(emulator->line(), HasSubstr("ready"));
    return emulator;
  }
  // The stack is what the printer's physics makes of this job file.
  void expect_stack(const std::string& stack, const std::string& job_path) {
    const auto job = JobReader::open(job_path);
    EmulatedJob sent;
    sent.header = job->header();
    for (const int layer : job->layers(RecordKind::kMask)) {
      sent.layers.push_back(*job->read_record(RecordKind::kMask, layer));
    }
    const std::string right = folder_ / "right";
    write_measured(print_volume(sent), right);
    EXPECT_EQ(names_in(stack), names_in(right));
    for (const std::string& name : names_in(right)) {
      EXPECT_EQ(file_text(stack + "/" + name), file_text(right + "/" + name)) << name;
    }
    EXPECT_EQ(StackReader(stack).info().kind, StackKind::kMeasured);
  }

  TempFolder folder_;
  std::string job_ = folder_ / "a.bjob";
  std::string printer_ = folder_ / "printer";
  std::string to_ = "emulator:" + printer_;
};

TEST_F(EmulatorVerb, TakesAJobAndLeavesWhatItPrinted) {
  const auto emulator = play();
  const Ended printed = run({"print", job_, "--to", to_, "--json"});
  ASSERT_EQ(printed.status, 0) << printed.err;
  EXPECT_EQ(printed.err, "");
  EXPECT_EQ(nlohmann::json::parse(printed.out)["printed"], printer_ + "/1");
  expect_stack(printer_ + "/1", job_);
  const Ended status = run({"status", "1", "--to", to_, "--json"});
  EXPECT_EQ(nlohmann::json::parse(status.out)["state"], "done") << status.err;
  EXPECT_THAT(run({"devices", "--to", to_}).out,
              testing::AllOf(HasSubstr("idle"), HasSubstr("printer EMU0001")));
  EXPECT_EQ(run({"print", job_, "--to", to_}).status, 0);
  expect_stack(printer_ + "/2", job_);

  emulator->signal(SIGTERM);
  const Ended ended = emulator->end();
  EXPECT_EQ(ended.status, 0);
  EXPECT_LT(ended.seconds, kAtOnce);
  EXPECT_THAT(ended.err,
              HasSubstr("job 1: begins, 40 layers\njob 1: done, 40 layers: " + printer_));
  const auto said = nlohmann::json::parse(ended.out);
  EXPECT_EQ(said["jobs"].size(), 2U);
  EXPECT_EQ(said["jobs"][1]["printed"], printer_ + "/2");
  EXPECT_THAT(names_in(printer_), testing::ElementsAre("1", "2", "jobs")) << "nothing half-written";
}

TEST_F(EmulatorVerb, HoldsAJobThatAFaultStoppedUntilItIsResumed) {
  const auto emulator = play({"--fault", "gone@12"});
  const Ended cut = run({"print", job_, "--to", to_});
  EXPECT_EQ(cut.status, 4);
  EXPECT_EQ(std::count(cut.err.begin(), cut.err.end(), '\n'), 1) << cut.err;
  EXPECT_THAT(cut.err, HasSubstr("unplugged or switched off"));
  EXPECT_THAT(cut.err, HasSubstr("binderjet resume 1 --to " + to_));
  EXPECT_FALSE(std::filesystem::exists(printer_ + "/1"));
  EXPECT_EQ(nlohmann::json::parse(run({"status", "1", "--to", to_, "--json"}).out)["state"],
            "held");
  const Ended resumed = run({"resume", "1", "--to", to_});
  EXPECT_EQ(resumed.status, 0) << resumed.err;
  expect_stack(printer_ + "/1", job_);
}

TEST_F(EmulatorVerb, ForgetsACancelledJob) {
  const auto emulator = play({"--fault", "out-of-powder@12"});
  EXPECT_THAT(run({"print", job_, "--to", to_}).err, HasSubstr("media-empty"));
  EXPECT_EQ(run({"print", job_, "--to", to_}).status, 4) << "it holds the first";
  EXPECT_EQ(run({"cancel", "1", "--to", to_}).status, 0);
  EXPECT_THAT(emulator->line(), HasSubstr("job 1: begins"));
  EXPECT_THAT(emulator->line(), HasSubstr("job 1: gone at layer 12 of 40"));
  const Ended again = run({"print", job_, "--to", to_, "--json"});
  ASSERT_EQ(again.status, 0) << again.err;
  expect_stack(nlohmann::json::parse(again.out)["printed"], job_);
  EXPECT_FALSE(std::filesystem::exists(printer_ + "/1"));
}

// A printer that is paused for good: whoever waits for it waits until he is told not to.
TEST_F(EmulatorVerb, AnswersCtrlCOnBothSides) {
  const auto emulator = play({"--fault", "paused@5"});
  Started print({"print", job_, "--to", to_}, true);
  EXPECT_THAT(emulator->line(), HasSubstr("job 1: begins"));
  // It stays at layer 5, so this ends.
  while (nlohmann::json::parse(run({"status", "1", "--to", to_, "--json"}).out)["acknowledged"] <
         5) {
  }
  print.signal(SIGINT);
  const Ended stopped = print.end();
  EXPECT_EQ(stopped.status, 130) << stopped.err;
  EXPECT_LT(stopped.seconds, kAtOnce);
  EXPECT_THAT(stopped.err, HasSubstr("binderjet resume 1"));
  emulator->signal(SIGINT);
  const Ended ended = emulator->end();
  EXPECT_EQ(ended.status, 0) << ended.err;
  EXPECT_LT(ended.seconds, kAtOnce);
  EXPECT_EQ(nlohmann::json::parse(ended.out)["jobs"][0]["done"], false);
  EXPECT_EQ(names_in(printer_), std::vector<std::string>{"jobs"});
  std::printf("print stopped in %.2f s, the emulator in %.2f s\n", stopped.seconds, ended.seconds);
}

TEST_F(EmulatorVerb, KilledEndsThePrintInOneLine) {
  const auto emulator = play({"--fault", "paused@5"});
  Started print({"print", job_, "--to", to_}, true);
  EXPECT_THAT(emulator->line(), HasSubstr("job 1: begins"));
  emulator->signal(SIGKILL);
  EXPECT_EQ(emulator->end().status, 128 + SIGKILL);
  const Ended ended = print.end();
  EXPECT_EQ(ended.status, 4);
  EXPECT_LT(ended.seconds, 20);
  EXPECT_EQ(std::count(ended.err.begin(), ended.err.end(), '\n'), 1) << ended.err;
  EXPECT_THAT(ended.err, HasSubstr("the emulated printer has ended"));
  EXPECT_THAT(ended.err, Not(HasSubstr("resume")));
  for (const char* verb : {"status", "cancel", "resume"}) {
    std::vector<std::string> words = {verb, "1", "--to", to_};
    const Ended refused = run(words);
    EXPECT_EQ(refused.status, 4) << verb;
    EXPECT_THAT(refused.err, HasSubstr("binderjet emulator -o " + printer_)) << verb;
    EXPECT_EQ(std::count(refused.err.begin(), refused.err.end(), '\n'), 1) << refused.err;
  }
  // The next takes the socket over, and has nothing of what the killed one held.
  const auto next = play();
  EXPECT_EQ(nlohmann::json::parse(run({"status", "--to", to_, "--json"}).out)["jobs"].size(), 0U);
  EXPECT_EQ(run({"print", job_, "--to", to_}).status, 0);
}

TEST_F(EmulatorVerb, IsOneInAFolder) {
  const auto emulator = play();
  const Ended second = run({"emulator", "-o", printer_});
  EXPECT_EQ(second.status, 4);
  EXPECT_THAT(second.err, HasSubstr(printer_ + ": another emulated printer has this folder"));
  EXPECT_EQ(run({"print", job_, "--to", to_}).status, 0) << "the first goes on";
}

TEST_F(EmulatorVerb, NamesTheFaultsWhereOneIsMisspelled) {
  const Ended ended = run({"emulator", "-o", printer_, "--fault", "stal@3"});
  EXPECT_EQ(ended.status, 2);
  EXPECT_THAT(ended.err, HasSubstr(" stall "));
}

// The header of a stranger's job is no reason for the printer to end.
TEST_F(EmulatorVerb, PrintsAJobWhoseHeaderSaysNothingAndSaysSo) {
  const auto emulator = play();
  auto writer = JobWriter::create(folder_ / "b.bjob", R"({"size_px": [9000000, 9000000, 1]})");
  ASSERT_TRUE(writer->append(print_records(0)));
  ASSERT_TRUE(writer->finish());
  const Ended printed = run({"print", folder_ / "b.bjob", "--to", to_});
  EXPECT_EQ(printed.status, 0);
  EXPECT_THAT(printed.err, HasSubstr("nothing is written"));
  EXPECT_THAT(printed.out, Not(HasSubstr("printed as")));
  EXPECT_THAT(emulator->line(), HasSubstr("job 1: begins"));
  EXPECT_THAT(emulator->line(), HasSubstr("nothing is written"));
  EXPECT_EQ(run({"print", job_, "--to", to_}).status, 0);
  expect_stack(printer_ + "/2", job_);
}

TEST_F(EmulatorVerb, IsPlayedByThePrintThatFindsNone) {
  const Ended printed = run({"print", job_, "--to", to_});
  ASSERT_EQ(printed.status, 0) << printed.err;
  EXPECT_EQ(printed.err, "no emulator is running at " + printer_ +
                             ": this program plays the printer for this job\n");
  EXPECT_THAT(printed.out, HasSubstr("printed as " + printer_ + "/1"));
  expect_stack(printer_ + "/1", job_);
  EXPECT_EQ(names_in(printer_), (std::vector<std::string>{"1", "jobs"}));
  EXPECT_EQ(run({"status", "--to", to_}).status, 4) << "it is gone with its job";
  EXPECT_EQ(run({"print", job_, "--to", to_, "-q"}).err, "");
  expect_stack(printer_ + "/2", job_);
}

TEST_F(EmulatorVerb, PlayedForOneJobLosesItWithItself) {
  write_job(folder_ / "long.bjob", 5000);
  Started print({"print", folder_ / "long.bjob", "--to", to_}, true);
  EXPECT_THAT(print.line(), StartsWith("no emulator is running"));
  print.signal(SIGINT);
  const Ended stopped = print.end();
  EXPECT_EQ(stopped.status, 130) << stopped.err;
  EXPECT_LT(stopped.seconds, kAtOnce);
  EXPECT_THAT(stopped.err, Not(HasSubstr("binderjet resume")));
  EXPECT_THAT(names_in(printer_), testing::IsSubsetOf({"jobs"}));
  const Ended again = run({"print", job_, "--to", to_});
  EXPECT_EQ(again.status, 0) << again.err;
}

}  // namespace
}  // namespace binderjet
