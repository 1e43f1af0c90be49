// SPDX-License-Identifier: GPL-3.0-or-later
// Senders die by SIGKILL at random moments, compete, and meet full disks: the spool keeps its word.
#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/mount.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <set>

#include "tests/transport/sample_job.h"
#include "transport/open/open_backend.h"

namespace binderjet {
namespace {

using testing::IsEmpty;

constexpr int kLayers = 150;

JobTicket ticket() { return {R"({"format": "job", "size_px": [64, 64, 150]})", kLayers, "a", ""}; }

struct Report {
  int id;            // 0 before start returned
  int acknowledged;  // layers; kLayers + 1 once end returned
};

// Sends a job, new or held, and reports each step down the pipe. False on any fault.
bool spool_job(const std::string& uri, const std::string& held, int pipe_fd) {
  const auto report = [pipe_fd](const std::string& id, int acknowledged) {
    const Report step{std::stoi(id), acknowledged};
    return pipe_fd < 0 || write(pipe_fd, &step, sizeof step) == sizeof step;
  };
  const auto backend = *open_backend(uri);
  std::string id = held;
  int first = 0;
  if (held.empty()) {
    const auto started = backend->start(ticket());
    if (!started) return false;
    id = *started;
    if (!report(id, 0)) return false;
  } else {
    const auto resumed = backend->resume(held, ticket());
    if (!resumed) return false;
    first = *resumed;
  }
  for (int layer = first; layer < kLayers; ++layer) {
    const auto acknowledged = backend->send(layer, sample_records(layer));
    if (!acknowledged || !report(id, *acknowledged)) return false;
  }
  return backend->end() && report(id, kLayers + 1);
}

// Runs `work` in a process of its own, which never runs this test's destructors.
template <class Work>
pid_t in_child(Work work) {
  const pid_t child = fork();
  if (child == 0) _exit(work() ? 0 : 1);
  return child;
}

bool succeeded(pid_t child) {
  int status = 0;
  return waitpid(child, &status, 0) == child && WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

std::string whole_job(const TempFolder& folder) {
  const std::string path = folder / "whole.bjob";
  if (!std::filesystem::exists(path)) write_sample_job(path, 0, kLayers, ticket().header);
  return file_text(path);
}

// Every name in the spool is one its description in spool.h knows, and done/ holds whole jobs only.
void expect_nothing_half_visible(const std::string& spool, const std::string& whole) {
  for (const std::string& name : names_in(spool + "/done")) {
    if (name.ends_with(".journal")) continue;
    ASSERT_TRUE(name.ends_with(".bjob")) << name;
    EXPECT_EQ(file_text(spool + "/done/" + name), whole) << name;
  }
  for (const char* place : {"/incoming/", "/held/"}) {
    for (const std::string& id : names_in(spool + place)) {
      for (const std::string& name : names_in(spool + place + id)) {
        EXPECT_TRUE(name == "journal" || name == "job.part") << name;
      }
    }
  }
}

class KilledSender : public testing::Test {
 protected:
  // Starts a sender and kills it after it made some number of reports and a moment more.
  Report killed(const std::string& held) {
    int ends[2];
    if (pipe2(ends, O_CLOEXEC) != 0) return {-1, 0};
    const pid_t child = in_child([&] {
      close(ends[0]);
      return spool_job(uri_, held, ends[1]);
    });
    close(ends[1]);
    const std::size_t patience = random_below(random_, kLayers + 10);
    Report last{0, 0};
    for (std::size_t i = 0; i < patience && take(ends[0], last); ++i) {
    }
    // A moment of up to 3 ms, so that deaths fall inside start, end and resume too.
    const auto moment = std::chrono::microseconds(random_below(random_, 3000));
    const auto begin = std::chrono::steady_clock::now();
    while (std::chrono::steady_clock::now() - begin < moment) {
    }
    kill(child, SIGKILL);
    waitpid(child, nullptr, 0);
    while (take(ends[0], last)) {
    }
    close(ends[0]);
    return last;
  }
  static bool take(int fd, Report& last) {
    Report step;
    if (read(fd, &step, sizeof step) != sizeof step) return false;
    last = step;
    return true;
  }

  TempFolder folder_;
  std::string spool_ = folder_ / "spool";
  std::string uri_ = "spool:" + spool_;
  std::mt19937_64 random_ = seeded_random();
};

TEST_F(KilledSender, LeavesEachJobWholeOrResumableAtAHundredRandomMoments) {
  const std::string whole = whole_job(folder_);
  int started = 0;
  int resumable = 0;
  int done = 0;
  std::string held;  // every other time the job left over is resumed, and killed again
  std::vector<Report> last_words;
  for (int round = 0; round < 100; ++round) {
    const Report last = killed(held);
    ASSERT_GE(last.id, 0);
    expect_nothing_half_visible(spool_, whole);
    if (last.id != 0) last_words.push_back(last);
    held.clear();
    // The first sender may die before there is a spool.
    const auto jobs = (*open_backend(uri_))->status();
    if (!jobs) continue;
    for (const JobStatus& job : *jobs) {
      ASSERT_NE(job.state, JobState::kIncoming) << "nobody sends job " << job.id;
      if (job.state == JobState::kHeld && round % 2 == 0) held = job.id;
    }
    if (last.id == 0) continue;
    const auto found = std::find_if(jobs->begin(), jobs->end(), [&last](const JobStatus& job) {
      return job.id == std::to_string(last.id);
    });
    ASSERT_NE(found, jobs->end()) << "job " << last.id << " was started and is lost";
    ASSERT_GE(found->acknowledged, std::min(last.acknowledged, kLayers)) << "job " << last.id;
    if (last.acknowledged > kLayers) {
      ASSERT_EQ(found->state, JobState::kDone) << "job " << last.id << " was reported done";
    }
  }
  const auto jobs = *(*open_backend(uri_))->status();
  for (const JobStatus& job : jobs) {
    ++started;
    if (job.state == JobState::kDone) {
      ++done;
      continue;
    }
    ++resumable;
    EXPECT_TRUE(spool_job(uri_, job.id, -1)) << "job " << job.id << " " << job.reason;
    EXPECT_EQ(file_text(spool_ + "/done/" + job.id + ".bjob"), whole);
  }
  std::printf("100 senders killed: %d jobs, %d done, %d resumed afterwards\n", started, done,
              resumable);
  EXPECT_GT(done, 0) << "the moments were all too early";
  EXPECT_GT(resumable, 0) << "the moments were all too late";
  expect_nothing_half_visible(spool_, whole);
  EXPECT_THAT(names_in(spool_ + "/held"), IsEmpty());
}

TEST(Spool, TakesJobsFromManyProcessesAtOnce) {
  const TempFolder folder;
  const std::string uri = "spool:" + (folder / "spool");
  const std::string whole = whole_job(folder);
  std::vector<pid_t> children;
  for (int i = 0; i < 6; ++i) {
    children.push_back(in_child([&uri] {
      return spool_job(uri, "", -1) && spool_job(uri, "", -1) && (*open_backend(uri))->status();
    }));
  }
  for (const pid_t child : children) EXPECT_TRUE(succeeded(child));
  const auto jobs = *(*open_backend(uri))->status();
  std::set<std::string> ids;
  for (const JobStatus& job : jobs) {
    EXPECT_EQ(job.state, JobState::kDone);
    ids.insert(job.id);
  }
  EXPECT_EQ(ids.size(), 12U);
  expect_nothing_half_visible(folder / "spool", whole);
}

// A disk of the size that the job does not fit on.
class FullDisk : public testing::Test {
 protected:
  void SetUp() override {
    std::filesystem::create_directory(disk_);
    if (mount("tmpfs", disk_.c_str(), "tmpfs", 0, "size=64k") != 0) {
      GTEST_SKIP() << "a small disk needs the right to mount one";
    }
    mounted_ = true;
  }
  void TearDown() override {
    if (mounted_) umount2(disk_.c_str(), MNT_DETACH);
  }
  TempFolder folder_;
  std::string disk_ = folder_ / "disk";
  bool mounted_ = false;
};

TEST_F(FullDisk, EndsASpooledJobInNoRoomAndHoldsIt) {
  const std::string spool = disk_ + "/spool";
  {
    const auto backend = *open_backend("spool:" + spool);
    ASSERT_TRUE(backend->start(ticket()));
    Result<int> sent = 0;
    for (int layer = 0; layer < kLayers && sent; ++layer) {
      sent = backend->send(layer, sample_records(layer));
    }
    ASSERT_FALSE(sent) << "the disk was not full";
    EXPECT_EQ(sent.error().kind, FailureKind::kNoRoom) << sent.error().what;
  }
  EXPECT_THAT(names_in(spool + "/done"), IsEmpty());
  EXPECT_THAT(names_in(spool + "/held"), testing::SizeIs(1));
  // Room is made, and the job goes on.
  ASSERT_EQ(mount("tmpfs", disk_.c_str(), "tmpfs", MS_REMOUNT, "size=4m"), 0);
  ASSERT_TRUE(spool_job("spool:" + spool, "1", -1));
  EXPECT_EQ(file_text(spool + "/done/1.bjob"), whole_job(folder_));
}

TEST_F(FullDisk, EndsAJobFileInNoRoomAndLeavesNothing) {
  auto writer = JobWriter::create(disk_ + "/a.bjob", ticket().header);
  ASSERT_TRUE(writer);
  {
    JobWriter doomed = std::move(*writer);
    Result<void> written;
    for (int layer = 0; layer < kLayers && written; ++layer) {
      written = doomed.append(sample_records(layer));
    }
    ASSERT_FALSE(written);
    EXPECT_EQ(written.error().kind, FailureKind::kNoRoom);
  }
  EXPECT_THAT(names_in(disk_), IsEmpty());
}

TEST_F(FullDisk, StartsNoJobWithoutRoom) {
  const std::string uri = "spool:" + disk_ + "/spool";
  ASSERT_TRUE((*open_backend(uri))->start(ticket()));
  std::ofstream(disk_ + "/ballast") << std::string(1 << 20, 'x');
  const auto id = (*open_backend(uri))->start(ticket());
  ASSERT_FALSE(id);
  EXPECT_EQ(id.error().kind, FailureKind::kNoRoom);
  EXPECT_THAT(names_in(disk_ + "/spool/incoming"), IsEmpty());
}

}  // namespace
}  // namespace binderjet
