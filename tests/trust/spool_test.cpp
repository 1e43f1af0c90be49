// SPDX-License-Identifier: GPL-3.0-or-later
// A spool with a thousand jobs, and programs that want the same one at the same time.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <thread>

#include "tests/support/models.h"
#include "tests/support/program.h"
#include "tests/transport/sample_job.h"
#include "transport/open/open_backend.h"

namespace binderjet {
namespace {

using testing::HasSubstr;

// In memory where there is such a place: a thousand jobs are thousands of syncs.
class BusySpool : public testing::Test {
 protected:
  BusySpool() {
    std::error_code error;
    const std::filesystem::path memory = "/dev/shm";
    folder_ = std::filesystem::is_directory(memory, error)
                  ? (memory / std::filesystem::path(here_ / "spool").parent_path().filename())
                  : std::filesystem::path(here_ / "spool");
    std::filesystem::create_directories(folder_);
    uri_ = "spool:" + folder_.string();
  }
  ~BusySpool() override {
    std::error_code error;
    std::filesystem::remove_all(folder_, error);
  }
  std::vector<JobStatus> status() const { return *(*open_backend(uri_))->status(); }
  std::string job_file(const std::string& name) const {
    models::write_obj(models::golf_ball(1, 3), here_ / "ball.obj");
    const Ran ran =
        here_.run({"slice", here_ / "ball.obj", "-p", "z450", "-q", "-o", here_ / name});
    EXPECT_EQ(ran.status, 0) << ran.err;
    return here_ / name;
  }

  Workplace here_;
  std::filesystem::path folder_;
  std::string uri_;
};

constexpr int kJobs = 1000;
constexpr int kJobLayers = 3;

TEST_F(BusySpool, StaysQuickAndRightWithAThousandJobs) {
  const JobTicket ticket{R"({"format": "job", "size_px": [64, 64, 3]})", kJobLayers, "a", ""};
  for (int job = 0; job < kJobs; ++job) {
    const auto backend = *open_backend(uri_);
    ASSERT_TRUE(backend->start(ticket));
    const bool leaves = job % 10 == 9;  // every tenth is held
    for (int layer = 0; layer < (leaves ? 1 : kJobLayers); ++layer) {
      ASSERT_TRUE(backend->send(layer, sample_records(layer)));
    }
    if (leaves) continue;
    ASSERT_TRUE(backend->end());
  }
  // In starts of the program, which every machine and sanitizer has at its own price.
  const double quick_seconds = 4 * here_.run({"--version"}).cpu_seconds;
  const Ran ran = here_.run({"status", "--to", uri_, "--json"});
  ASSERT_EQ(ran.status, 0) << ran.err;
  EXPECT_LT(ran.cpu_seconds, quick_seconds);
  const auto jobs = ran.json()["jobs"];
  ASSERT_EQ(jobs.size(), kJobs);
  for (int job = 0; job < kJobs; ++job) {
    const auto& said = jobs[static_cast<std::size_t>(job)];
    const bool held = job % 10 == 9;
    ASSERT_EQ(said["job"], std::to_string(job + 1));
    ASSERT_EQ(said["state"], held ? "held" : "done");
    ASSERT_EQ(said["acknowledged"], held ? 1 : kJobLayers);
  }
  const Ran one = here_.run({"status", "700", "--to", uri_, "--json"});
  EXPECT_EQ(one.json()["state"], "held");
  EXPECT_LT(one.cpu_seconds, quick_seconds);
  const Ran cancelled = here_.run({"cancel", "700", "--to", uri_});
  EXPECT_EQ(cancelled.status, 0) << cancelled.err;
  EXPECT_EQ(status().size(), kJobs - 1);
}

TEST_F(BusySpool, TakesJobsFromProgramsAtTheSameTime) {
  const std::string job = job_file("a.bjob");
  std::vector<std::thread> programs;
  std::array<int, 4> answers{};
  for (int& answer : answers) {
    programs.emplace_back([&] {
      const std::string command =
          std::string(BINDERJET_PROGRAM) + " print " + job + " --to " + uri_ + " -q 2> /dev/null";
      answer = std::system(command.c_str());
    });
  }
  for (std::thread& program : programs) program.join();
  EXPECT_THAT(answers, testing::Each(0));
  ASSERT_EQ(status().size(), answers.size());
  for (int id = 1; id <= 4; ++id) {
    EXPECT_EQ(file_text(folder_.string() + "/done/" + std::to_string(id) + ".bjob"),
              file_text(job));
  }
}

TEST_F(BusySpool, TellsTheSecondThatTheJobIsBeingSent) {
  const std::string job = job_file("a.bjob");
  const auto reader = *JobReader::open(job);
  const auto backend = *open_backend(uri_);
  const int layers = static_cast<int>(reader.layers(RecordKind::kMask).size());
  ASSERT_TRUE(backend->start({reader.header(), layers, "a.bjob", job}));
  const auto record = reader.read_record(RecordKind::kMask, 0);
  ASSERT_TRUE(backend->send(0, *record));
  const Ran second = here_.run({"resume", "1", "--to", uri_, "--job", job});
  EXPECT_EQ(second.status, 3) << second.err;
  EXPECT_THAT(second.err, HasSubstr("being sent by another process"));
  for (int layer = 1; layer < layers; ++layer) {
    ASSERT_TRUE(backend->send(layer, *reader.read_record(RecordKind::kMask, layer)));
  }
  ASSERT_TRUE(backend->end());
  EXPECT_EQ(file_text(folder_.string() + "/done/1.bjob"), file_text(job));
}

}  // namespace
}  // namespace binderjet
