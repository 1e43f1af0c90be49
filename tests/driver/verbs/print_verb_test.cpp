// SPDX-License-Identifier: GPL-3.0-or-later
// print, join and the queue's verbs, as the command line runs them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "driver/verbs/verbs.h"
#include "slicer/base/error.h"
#include "tests/transport/sample_job.h"

namespace binderjet {
namespace {

using testing::HasSubstr;

class PrintVerb : public testing::Test {
 protected:
  PrintVerb() { write_sample_job(folder_ / "a.bjob", 0, 40); }

  // What a verb says on stdout.
  std::string run(const std::vector<std::string>& words) {
    CLI::App program;
    add_print_verb(program);
    add_queue_verbs(program);
    add_join_verb(program);
    std::vector<std::string> reversed(words.rbegin(), words.rend());  // as CLI11 wants them
    testing::internal::CaptureStdout();
    try {
      program.parse(reversed);
    } catch (...) {
      testing::internal::GetCapturedStdout();
      throw;
    }
    return testing::internal::GetCapturedStdout();
  }
  nlohmann::json run_json(std::vector<std::string> words) {
    words.emplace_back("--json");
    return nlohmann::json::parse(run(words));
  }
  // The exit status and the line of a verb that ends in an Error.
  std::pair<int, std::string> error_of(const std::vector<std::string>& words) {
    try {
      run(words);
    } catch (const Error& error) {
      return {static_cast<int>(error.kind()), error.what()};
    }
    return {0, ""};
  }

  TempFolder folder_;
  std::string to_ = "spool:" + (folder_ / "spool");
};

TEST_F(PrintVerb, PutsAJobIntoASpoolAndStatusFindsItThere) {
  const auto printed = run_json({"print", folder_ / "a.bjob", "--to", to_});
  EXPECT_EQ(printed["layers"], 40);
  const std::string id = printed["job"];
  EXPECT_EQ(file_text(folder_ / ("spool/done/" + id + ".bjob")), file_text(folder_ / "a.bjob"));
  const auto status = run_json({"status", id, "--to", to_});
  EXPECT_EQ(status["state"], "done");
  EXPECT_EQ(status["acknowledged"], 40);
  EXPECT_EQ(run_json({"status", "--to", to_})["jobs"].size(), 1U);
  EXPECT_EQ(run_json({"devices", "--to", to_})["devices"][0]["state"], "idle");
  EXPECT_EQ(run({"print", folder_ / "a.bjob", "--to", to_, "-q"}), "");
}

// A damaged record stops the print in the middle, as an interruption would.
TEST_F(PrintVerb, SaysHowToResumeAndResumesToTheSameBytes) {
  const std::string right = file_text(folder_ / "a.bjob");
  std::string wrong = right;
  const auto entry = JobReader::open(folder_ / "a.bjob")->entries()[60];  // layer 30: each has two
  wrong[entry.offset + 50] = static_cast<char>(wrong[entry.offset + 50] ^ 1);
  write_text(folder_ / "a.bjob", wrong);
  const auto [status, line] = error_of({"print", folder_ / "a.bjob", "--to", to_});
  EXPECT_EQ(status, 3);
  EXPECT_THAT(line, HasSubstr("layer 30 is damaged"));
  EXPECT_THAT(line, HasSubstr("binderjet resume 1 --to " + to_));
  EXPECT_EQ(run_json({"status", "1", "--to", to_})["state"], "held");
  write_text(folder_ / "a.bjob", right);
  EXPECT_EQ(run_json({"resume", "1", "--to", to_})["layers"], 40);
  EXPECT_EQ(file_text(folder_ / "spool/done/1.bjob"), right);
}

TEST_F(PrintVerb, RefusesWhatIsNotAWholeJob) {
  write_sample_job(folder_ / "share.bjob", 0, 20);
  EXPECT_THAT(error_of({"print", folder_ / "share.bjob", "--to", to_}).second,
              HasSubstr("layer 20 of 40 is missing"));
  std::filesystem::resize_file(folder_ / "a.bjob", 9000);
  const auto [status, line] = error_of({"print", folder_ / "a.bjob", "--to", to_});
  EXPECT_EQ(status, 3);
  EXPECT_THAT(line, HasSubstr("cut after layer"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "spool")) << "refused before anything is sent";
}

TEST_F(PrintVerb, EndsInTheStatusThatSaysWhoIsToBlame) {
  EXPECT_EQ(error_of({"print", folder_ / "a.bjob", "--to", "ftp://x"}).first, 2);
  EXPECT_EQ(error_of({"print", folder_ / "no.bjob", "--to", to_}).first, 3);
  EXPECT_EQ(error_of({"status", "--to", to_}).first, 4);
  run({"print", folder_ / "a.bjob", "--to", to_});
  EXPECT_EQ(error_of({"cancel", "1", "--to", to_}).first, 3);
  EXPECT_EQ(error_of({"status", "7", "--to", to_}).first, 3);
}

TEST_F(PrintVerb, PrintsIntoAFile) {
  run({"print", folder_ / "a.bjob", "--to", "file:" + (folder_ / "b.bjob")});
  EXPECT_EQ(file_text(folder_ / "b.bjob"), file_text(folder_ / "a.bjob"));
}

TEST_F(PrintVerb, JoinsSharesBeforeThat) {
  write_sample_job(folder_ / "s1", 0, 13);
  write_sample_job(folder_ / "s2", 13, 40);
  const auto joined =
      run_json({"join", folder_ / "s2", folder_ / "s1", "-o", folder_ / "joined.bjob"});
  EXPECT_EQ(joined["layers"], 40);
  EXPECT_EQ(file_text(folder_ / "joined.bjob"), file_text(folder_ / "a.bjob"));
  EXPECT_EQ(error_of({"join", folder_ / "s2", "-o", folder_ / "no.bjob"}).first, 3);
}

}  // namespace
}  // namespace binderjet
