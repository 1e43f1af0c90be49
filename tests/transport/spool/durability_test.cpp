// SPDX-License-Identifier: GPL-3.0-or-later
// What is only written, a loss of power takes: the order in which the disk is asked for it.
#include <fcntl.h>
#include <fmt/core.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/syscall.h>

#include <filesystem>

#include "tests/transport/sample_job.h"
#include "transport/open/open_backend.h"

namespace {

std::vector<std::string>* asked = nullptr;  // null while nobody looks

std::string base_name(const std::string& path) { return path.substr(path.rfind('/') + 1); }

// With the size that a file has at that moment.
void note_sync(int fd) {
  if (asked == nullptr) return;
  const std::string path =
      std::filesystem::read_symlink(fmt::format("/proc/self/fd/{}", fd)).string();
  const bool folder = std::filesystem::is_directory(path);
  asked->push_back(
      folder ? "sync " + base_name(path)
             : fmt::format("sync {} {}", base_name(path), std::filesystem::file_size(path)));
}

}  // namespace

// In place of the C library's, for this program.
extern "C" int fdatasync(int fd) {
  note_sync(fd);
  return static_cast<int>(syscall(SYS_fdatasync, fd));
}
extern "C" int fsync(int fd) {
  note_sync(fd);
  return static_cast<int>(syscall(SYS_fsync, fd));
}
extern "C" int rename(const char* from, const char* to) noexcept {
  if (asked != nullptr) {
    asked->push_back(fmt::format("rename {} {}", base_name(from), base_name(to)));
  }
  return renameat(AT_FDCWD, from, AT_FDCWD, to);
}

namespace binderjet {
namespace {

using testing::ElementsAre;

class Durability : public testing::Test {
 protected:
  ~Durability() override { asked = nullptr; }
  std::vector<std::string> while_in(const std::function<void()>& act) {
    std::vector<std::string> events;
    asked = &events;
    act();
    asked = nullptr;
    return events;
  }
  TempFolder folder_;
};

TEST_F(Durability, OfALayerIsThatOfItsRecordsAndThenOfTheLineThatAcknowledgesIt) {
  const auto backend = *open_backend("spool:" + (folder_ / "spool"));
  ASSERT_TRUE(backend->start({kSampleHeader, 2, "a", "a.bjob"}));
  const auto asked_for =
      while_in([&] { EXPECT_EQ(*backend->send(0, sample_records(0)), 1) << "acknowledged"; });
  const std::string job = folder_ / "spool/incoming/1/";
  EXPECT_THAT(
      asked_for,
      ElementsAre(fmt::format("sync job.part {}", std::filesystem::file_size(job + "job.part")),
                  fmt::format("sync journal {}", std::filesystem::file_size(job + "journal"))));
}

TEST_F(Durability, OfAJobComesBeforeItsName) {
  auto writer = JobWriter::create(folder_ / "a.bjob", kSampleHeader);
  ASSERT_TRUE(writer && writer->append(sample_records(0)));
  const auto asked_for = while_in([&] { EXPECT_TRUE(writer->finish()); });
  ASSERT_EQ(asked_for.size(), 3U);
  EXPECT_THAT(asked_for[0], testing::EndsWith(fmt::format(
                                ".part {}", std::filesystem::file_size(folder_ / "a.bjob"))));
  EXPECT_THAT(asked_for[1], testing::EndsWith(".part a.bjob"));
  EXPECT_EQ(asked_for[2], "sync " + base_name(folder_.path())) << "the name, too, must last";
}

}  // namespace
}  // namespace binderjet
