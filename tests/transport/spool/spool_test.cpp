// SPDX-License-Identifier: GPL-3.0-or-later
// The spool takes whole jobs, holds what stopped, and goes on from what it acknowledged.
#include "transport/spool/spool.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "tests/transport/sample_job.h"
#include "transport/open/open_backend.h"
#include "transport/spool/journal.h"
#include "transport/spool/spooled_job.h"

namespace binderjet {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr int kSpoolLayers = 40;

class SpoolTest : public testing::Test {
 protected:
  SpoolTest() {
    write_sample_job(folder_ / "whole.bjob", 0, kSpoolLayers);
    ticket_ = {kSampleHeader, kSpoolLayers, "part one.bjob", folder_ / "whole.bjob"};
  }
  std::unique_ptr<Backend> backend() const { return *open_backend("spool:" + spool_); }
  // Sends layers [first, end).
  static Result<int> send(Backend& backend, int first, int end) {
    Result<int> acknowledged = first;
    for (int layer = first; layer < end && acknowledged; ++layer) {
      acknowledged = backend.send(layer, sample_records(layer));
    }
    return acknowledged;
  }
  // A job of which some layers were sent, by a backend that is gone.
  std::string held_job(int layers) {
    const auto sender = backend();
    const auto id = sender->start(ticket_);
    EXPECT_TRUE(id) << id.error().what;
    EXPECT_TRUE(send(*sender, 0, layers));
    return *id;
  }
  JobStatus only_job() const {
    const auto jobs = backend()->status();
    EXPECT_TRUE(jobs && jobs->size() == 1);
    return jobs && jobs->size() == 1 ? jobs->front() : JobStatus{};
  }
  std::string done_text(const std::string& id) const {
    return file_text(spool_ + "/done/" + id + ".bjob");
  }
  std::string whole_text() const { return file_text(folder_ / "whole.bjob"); }

  TempFolder folder_;
  std::string spool_ = folder_ / "spool";
  JobTicket ticket_;
};

TEST_F(SpoolTest, TakesAWholeJobByteForByte) {
  const auto sender = backend();
  const auto id = sender->start(ticket_);
  ASSERT_TRUE(id) << id.error().what;
  EXPECT_EQ(only_job().state, JobState::kIncoming);
  ASSERT_TRUE(send(*sender, 0, kSpoolLayers));
  EXPECT_THAT(names_in(spool_ + "/done"), IsEmpty()) << "visible before its end";
  ASSERT_TRUE(sender->end());
  EXPECT_EQ(done_text(*id), whole_text());
  EXPECT_THAT(names_in(spool_ + "/incoming"), IsEmpty());
  EXPECT_THAT(names_in(spool_ + "/held"), IsEmpty());
  const JobStatus job = only_job();
  EXPECT_EQ(job.state, JobState::kDone);
  EXPECT_EQ(job.acknowledged, kSpoolLayers);
  EXPECT_EQ(job.name, "part one.bjob") << "blanks in a name survive the journal";
}

TEST_F(SpoolTest, AcknowledgesALayerThatComesAlone) {
  const auto sender = backend();
  ASSERT_TRUE(sender->start(ticket_));
  EXPECT_EQ(*send(*sender, 0, 1), 1);
}

TEST_F(SpoolTest, AcknowledgesNothingThatIsNotInItsJournal) {
  const auto sender = backend();
  const auto id = sender->start(ticket_);
  for (int layer = 0; layer < kSpoolLayers; ++layer) {
    const auto acknowledged = sender->send(layer, sample_records(layer));
    ASSERT_TRUE(acknowledged);
    EXPECT_EQ(Journal::peek(spool_ + "/incoming/" + *id + "/journal")->acknowledged, *acknowledged);
  }
}

TEST_F(SpoolTest, HoldsAJobWhoseSenderStops) {
  const std::string id = held_job(10);
  EXPECT_THAT(names_in(spool_ + "/held"), ElementsAre(id));
  const JobStatus job = only_job();
  EXPECT_EQ(job.state, JobState::kHeld);
  EXPECT_THAT(job.reason, HasSubstr("sender stopped"));
  EXPECT_EQ(job.source, folder_ / "whole.bjob");
}

TEST_F(SpoolTest, ResumesFromAnyLayerToTheSameBytes) {
  for (const int stop : {0, 1, 17, 39, 40}) {
    const std::string id = held_job(stop);
    const auto sender = backend();
    const auto first = sender->resume(id, ticket_);
    ASSERT_TRUE(first) << first.error().what;
    EXPECT_LE(*first, stop);
    ASSERT_TRUE(send(*sender, *first, kSpoolLayers));
    ASSERT_TRUE(sender->end());
    EXPECT_EQ(done_text(id), whole_text());
  }
}

TEST_F(SpoolTest, ResumesAJobTwice) {
  const std::string id = held_job(5);
  {
    const auto sender = backend();
    const int first = *sender->resume(id, ticket_);
    ASSERT_TRUE(send(*sender, first, 20));
  }
  const auto sender = backend();
  const int first = *sender->resume(id, ticket_);
  ASSERT_TRUE(send(*sender, first, kSpoolLayers));
  ASSERT_TRUE(sender->end());
  EXPECT_EQ(done_text(id), whole_text());
}

TEST_F(SpoolTest, RefusesToResumeWithAnotherJob) {
  const std::string id = held_job(5);
  JobTicket other = ticket_;
  other.header = "another";
  EXPECT_THAT(backend()->resume(id, other).error().what, HasSubstr("another job file"));
  other = ticket_;
  other.layer_count = 41;
  EXPECT_THAT(backend()->resume(id, other).error().what, HasSubstr("another job file"));
  EXPECT_TRUE(backend()->resume(id, ticket_)) << "and leaves the job as it was";
}

TEST_F(SpoolTest, LetsOneProcessSendAJob) {
  const auto sender = backend();
  const auto id = sender->start(ticket_);
  EXPECT_THAT(backend()->resume(*id, ticket_).error().what, HasSubstr("another process"));
  EXPECT_TRUE(send(*sender, 0, 3));
}

TEST_F(SpoolTest, RefusesLayersOutOfOrderAndHoldsTheJob) {
  const auto sender = backend();
  ASSERT_TRUE(sender->start(ticket_));
  ASSERT_TRUE(send(*sender, 0, 3));
  EXPECT_THAT(sender->send(4, sample_records(4)).error().what,
              HasSubstr("layer 4 came where layer 3 of 40"));
  EXPECT_EQ(only_job().state, JobState::kHeld);
}

TEST_F(SpoolTest, DoesNotEndAJobWithLayersMissing) {
  const auto sender = backend();
  ASSERT_TRUE(sender->start(ticket_));
  ASSERT_TRUE(send(*sender, 0, 39));
  EXPECT_THAT(sender->end().error().what, HasSubstr("before layer 39 of 40"));
  EXPECT_EQ(only_job().state, JobState::kHeld);
  EXPECT_THAT(names_in(spool_ + "/done"), IsEmpty());
}

TEST_F(SpoolTest, CancelsAHeldJob) {
  const std::string id = held_job(10);
  ASSERT_TRUE(backend()->cancel(id));
  EXPECT_THAT(*backend()->status(), IsEmpty());
  EXPECT_THAT(names_in(spool_ + "/held"), IsEmpty());
}

TEST_F(SpoolTest, CancelsAJobThatIsBeingSent) {
  const auto sender = backend();
  const auto id = sender->start(ticket_);
  ASSERT_TRUE(send(*sender, 0, 3));
  ASSERT_TRUE(backend()->cancel(*id));
  const auto stopped = sender->send(3, sample_records(3));
  ASSERT_FALSE(stopped);
  EXPECT_EQ(stopped.error().kind, FailureKind::kInterrupted);
  EXPECT_THAT(stopped.error().what, HasSubstr("cancelled before layer 3"));
  EXPECT_THAT(*backend()->status(), IsEmpty());
}

TEST_F(SpoolTest, CancelsAJobJustBeforeItsEnd) {
  const auto sender = backend();
  const auto id = sender->start(ticket_);
  ASSERT_TRUE(send(*sender, 0, kSpoolLayers));
  ASSERT_TRUE(backend()->cancel(*id));
  EXPECT_FALSE(sender->end());
  EXPECT_THAT(names_in(spool_ + "/done"), IsEmpty());
}

TEST_F(SpoolTest, KeepsADoneJobFromCancelAndResume) {
  const auto sender = backend();
  const auto id = sender->start(ticket_);
  ASSERT_TRUE(send(*sender, 0, kSpoolLayers) && sender->end());
  EXPECT_THAT(backend()->cancel(*id).error().what, HasSubstr("too late"));
  EXPECT_THAT(backend()->resume(*id, ticket_).error().what, HasSubstr("nothing to resume"));
  EXPECT_EQ(done_text(*id), whole_text());
}

TEST_F(SpoolTest, TakesNoPathForAnId) {
  held_job(1);
  for (const char* id : {"..", "../held/1", "", "01", "99", "1/../1"}) {
    EXPECT_FALSE(backend()->cancel(id)) << id;
    EXPECT_FALSE(backend()->resume(id, ticket_)) << id;
  }
  EXPECT_EQ(only_job().state, JobState::kHeld);
}

TEST_F(SpoolTest, NeverGivesAnIdTwice) {
  const std::string first = held_job(1);
  ASSERT_TRUE(backend()->cancel(first));
  const std::string second = held_job(1);
  EXPECT_NE(first, second);
  std::filesystem::remove(spool_ + "/last-id");
  write_text(spool_ + "/last-id", "");
  EXPECT_NE(held_job(1), second) << "even if its counter is lost";
}

TEST_F(SpoolTest, MakesNoSpoolWhereTheParentIsMissing) {
  const auto started = (*open_backend("spool:" + (folder_ / "no/such/spool")))->start(ticket_);
  ASSERT_FALSE(started);
  EXPECT_EQ(started.error().kind, FailureKind::kDevice);
}

// Its layers are at the device, and the spool would call it done without them.
TEST_F(SpoolTest, RefusesToResumeWhatADeviceHas) {
  const Spool spool(spool_);
  ASSERT_TRUE(spool.create());
  std::string id;
  {
    const auto lock = spool.lock();
    ASSERT_TRUE(lock);
    const auto job = start_job(spool, *lock, ticket_, {"usb:abc", 7});
    ASSERT_TRUE(job) << job.error().what;
    id = job->id;
    ASSERT_TRUE(spool.hold(id));
  }
  const auto resumed = backend()->resume(id, ticket_);
  ASSERT_FALSE(resumed);
  EXPECT_THAT(resumed.error().what, HasSubstr("is at usb:abc: resume it with --to usb:abc"));
  EXPECT_EQ(only_job().state, JobState::kHeld);
  EXPECT_EQ(only_job().acknowledged, 0);
}

TEST_F(SpoolTest, MakesNoSpoolOfAFolderWithOtherThings) {
  std::filesystem::create_directory(spool_);
  std::ofstream(spool_ + "/thesis.txt") << "mine";
  const auto started = backend()->start(ticket_);
  ASSERT_FALSE(started);
  EXPECT_THAT(started.error().what, HasSubstr("holds thesis.txt and is no spool"));
  EXPECT_THAT(names_in(spool_), ElementsAre("thesis.txt"));
}

TEST_F(SpoolTest, FollowsNoLinkInThePlaceOfItsCounter) {
  held_job(1);
  std::filesystem::remove(spool_ + "/last-id");
  std::ofstream(folder_ / "passwd") << "root";
  std::filesystem::create_symlink(folder_ / "passwd", spool_ + "/last-id");
  EXPECT_FALSE(backend()->start(ticket_));
  std::filesystem::remove(spool_ + "/last-id");
  std::filesystem::create_hard_link(folder_ / "passwd", spool_ + "/last-id");
  const auto started = backend()->start(ticket_);
  ASSERT_FALSE(started);
  EXPECT_THAT(started.error().what, HasSubstr("a link"));
  EXPECT_EQ(file_text(folder_ / "passwd"), "root");
}

TEST_F(SpoolTest, GivesNoNumberThatItWouldNotFindAgain) {
  held_job(1);
  std::ofstream(spool_ + "/last-id") << "999999999999999999";
  const auto started = backend()->start(ticket_);
  ASSERT_FALSE(started);
  EXPECT_THAT(started.error().what, HasSubstr("has no number left after 999999999999999999"));
  EXPECT_THAT(names_in(spool_ + "/incoming"), IsEmpty());
}

TEST_F(SpoolTest, SaysThatThereIsNoSpool) {
  EXPECT_THAT(backend()->status().error().what, HasSubstr("no spool is here"));
  EXPECT_FALSE(std::filesystem::exists(spool_)) << "asking makes none";
}

// What the death of the machine leaves of a journal: its beginning.
TEST_F(SpoolTest, ResumesWithAJournalCutAnywhere) {
  const std::string id = held_job(5);
  const std::string journal_path = spool_ + "/held/" + id + "/journal";
  const std::string journal = file_text(journal_path);
  const std::string part = file_text(spool_ + "/held/" + id + "/job.part");
  // Longer than the rest of the job, which would otherwise hide it.
  const std::string rubbish(whole_text().size(), 'x');
  const std::size_t start_line = journal.find('\n') + 1;
  for (std::size_t length = start_line; length <= journal.size(); length += 3) {
    std::filesystem::create_directories(spool_ + "/held/" + id);
    write_text(journal_path, journal.substr(0, length));
    write_text(spool_ + "/held/" + id + "/job.part", part + rubbish);
    {
      const auto sender = backend();
      const auto first = sender->resume(id, ticket_);
      ASSERT_TRUE(first) << first.error().what;
      ASSERT_TRUE(send(*sender, *first, kSpoolLayers));
      ASSERT_TRUE(sender->end());
    }
    ASSERT_EQ(done_text(id), whole_text());
    std::filesystem::remove(spool_ + "/done/" + id + ".bjob");
  }
}

TEST_F(SpoolTest, SaysWhenTheDiskLostAcknowledgedLayers) {
  const std::string id = held_job(10);
  const std::string part = spool_ + "/held/" + id + "/job.part";
  ASSERT_GT(only_job().acknowledged, 0);
  std::filesystem::resize_file(part, 200);
  const auto resumed = backend()->resume(id, ticket_);
  ASSERT_FALSE(resumed);
  EXPECT_THAT(resumed.error().what, HasSubstr("cancel it and print again"));
}

TEST_F(SpoolTest, FinishesWhatADeathBetweenTheLastTwoRenamesLeft) {
  const std::string id = held_job(kSpoolLayers);
  std::filesystem::rename(spool_ + "/held/" + id, spool_ + "/incoming/" + id);
  std::filesystem::remove(spool_ + "/incoming/" + id + "/job.part");
  std::filesystem::copy_file(folder_ / "whole.bjob", spool_ + "/done/" + id + ".bjob");
  EXPECT_EQ(only_job().state, JobState::kDone);
  EXPECT_THAT(names_in(spool_ + "/incoming"), IsEmpty());
  EXPECT_THAT(names_in(spool_ + "/done"), ElementsAre(id + ".bjob", id + ".journal"));
}

TEST_F(SpoolTest, RemovesAJobThatNeverStarted) {
  held_job(1);
  std::filesystem::create_directory(spool_ + "/incoming/77");
  write_text(spool_ + "/incoming/77/journal", "start 1 40");
  EXPECT_EQ(backend()->status()->size(), 1U);
  EXPECT_THAT(names_in(spool_ + "/incoming"), IsEmpty());
}

TEST(Journal, BelievesNoChangedLine) {
  const TempFolder folder;
  {
    JournalState start;
    start.layer_count = 40;
    start.name = "a";
    auto journal = Journal::create(folder / "journal", start);
    ASSERT_TRUE(journal->acknowledge(1, 100) && journal->acknowledge(2, 200));
    ASSERT_TRUE(journal->held("50 % of the powder\nis gone"));
  }
  const std::string text = file_text(folder / "journal");
  EXPECT_EQ(Journal::peek(folder / "journal")->held, "50 % of the powder\nis gone");
  for (std::size_t i = 0; i < text.size(); ++i) {
    std::string changed = text;
    changed[i] = changed[i] == '1' ? '2' : '1';
    write_text(folder / "journal", changed);
    const auto state = Journal::peek(folder / "journal");
    ASSERT_TRUE(state);
    const auto lines =
        std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(i), '\n');
    EXPECT_EQ(state->started, lines > 0);
    EXPECT_EQ(state->acknowledged,
              std::max<std::ptrdiff_t>(0, std::min<std::ptrdiff_t>(lines, 3) - 1));
  }
}

TEST(Journal, RemembersTheDeviceAndTheDigest) {
  const TempFolder folder;
  JournalState start;
  start.layer_count = 40;
  start.to = "usb://1209:0001/A B";
  start.key = 0xfedcba9876543210;
  ASSERT_TRUE(Journal::create(folder / "journal", start)->acknowledge(7, 0, 0x8000000000000001));
  const auto state = Journal::peek(folder / "journal");
  ASSERT_TRUE(state && state->started);
  EXPECT_EQ(state->to, start.to);
  EXPECT_EQ(state->key, start.key);
  EXPECT_EQ(state->acknowledged, 7);
  EXPECT_EQ(state->digest, 0x8000000000000001);
}

TEST(FileBackend, WritesTheSameJobAndNothingHalf) {
  const TempFolder folder;
  write_sample_job(folder / "whole.bjob", 0, kSpoolLayers);
  for (const int stop : {kSpoolLayers, 20}) {
    const auto backend = *open_backend("file:" + (folder / "out.bjob"));
    ASSERT_TRUE(backend->start({kSampleHeader, kSpoolLayers, "a", ""}));
    for (int layer = 0; layer < stop; ++layer) {
      EXPECT_EQ(*backend->send(layer, sample_records(layer)), 0) << "nothing would survive yet";
    }
    EXPECT_EQ(backend->end().has_value(), stop == kSpoolLayers);
    EXPECT_EQ(file_text(folder / "out.bjob"), file_text(folder / "whole.bjob"));
    EXPECT_THAT(names_in(folder.path()), ElementsAre("out.bjob", "whole.bjob"));
  }
}

TEST(Backend, IsChosenByItsUri) {
  EXPECT_TRUE(open_backend("file:a.bjob"));
  EXPECT_TRUE(open_backend("spool:/tmp/spool/"));
  for (const char* uri : {"", "spool", "spool:", "ftp://host/x", "/tmp/a.bjob"}) {
    EXPECT_FALSE(open_backend(uri)) << uri;
  }
}

}  // namespace
}  // namespace binderjet
