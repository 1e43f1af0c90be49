// SPDX-License-Identifier: GPL-3.0-or-later
// The spool's folders and how jobs move between them.
#include "transport/spool/spool.h"

#include <fcntl.h>
#include <fmt/core.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <filesystem>
#include <optional>
#include <utility>

#include "transport/job/job_file.h"

namespace binderjet {
namespace {

namespace fs = std::filesystem;

std::uint64_t id_number(std::string_view text) {
  std::uint64_t number = 0;
  std::from_chars(text.data(), text.data() + text.size(), number);
  return number;
}

Result<void> move_synced(const std::string& from, const std::string& to) {
  if (auto done = rename_path(from, to); !done) return done;
  if (auto done = sync_folder(folder_of(to)); !done) return done;
  return sync_folder(folder_of(from));
}

bool has_line(const std::string& path) {
  const Result<File> file = open_file(path, O_RDONLY);
  if (!file) return path_exists(path);
  std::array<std::byte, 4096> some{};
  const ssize_t size = pread(file->fd(), some.data(), some.size(), 0);
  // A start line longer than this has at least been begun in earnest: keep it.
  return size == static_cast<ssize_t>(some.size()) ||
         std::find(some.begin(), some.begin() + std::max<ssize_t>(size, 0), std::byte{'\n'}) !=
             some.begin() + std::max<ssize_t>(size, 0);
}

// The counter and lock of a spool. In a folder that others can write to, a link put in its place
// would have us write into the file it leads to.
Result<File> open_counter(const std::string& folder, int flags) {
  const std::string path = folder + "/last-id";
  Result<File> file = open_file(path, O_RDWR | O_NOFOLLOW | flags);
  if (!file) return file;
  struct stat info = {};
  if (fstat(file->fd(), &info) != 0 || !S_ISREG(info.st_mode) || info.st_nlink != 1) {
    return tl::unexpected(Failure{FailureKind::kDevice, path,
                                  "is no file of this spool alone but a link; remove it"});
  }
  return file;
}

// A spool, or the beginning of one: `incoming` is the first that create() makes.
bool is_spool(const std::string& folder) {
  return path_exists(folder + "/last-id") || path_exists(folder + "/incoming");
}

// Nobody's home or project becomes a spool by a slip of the hand.
Result<void> check_room_for_spool(const std::string& folder) {
  if (is_spool(folder)) return {};
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder.empty() ? "/" : folder, error)) {
    if (entry.path().filename() == "lost+found") continue;  // a disk of its own
    // Another process may have begun the spool since: what we see here is then its own.
    if (is_spool(folder)) return {};
    return tl::unexpected(Failure{FailureKind::kBadInput, "spool:" + folder,
                                  "holds " + entry.path().filename().string() +
                                      " and is no spool; name a new or an empty folder"});
  }
  return {};
}

}  // namespace

bool is_job_id(const std::string& text) {
  return !text.empty() && text.size() <= 18 && text[0] != '0' &&
         std::all_of(text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; });
}

Result<void> Spool::create() const {
  if (auto room = check_room_for_spool(folder_); !room) return room;
  for (const char* place : {"", "/incoming", "/held", "/done"}) {
    if (path_exists(folder_ + place)) continue;
    if (auto done = make_folder(folder_ + place); !done) return done;
    if (auto done = sync_folder(folder_of(folder_ + place)); !done) return done;
  }
  const Result<File> counter = open_counter(folder_, O_CREAT);
  if (!counter) return tl::unexpected(counter.error());
  return {};
}

Result<File> Spool::lock() const {
  if (!path_exists(folder_ + "/last-id")) {
    return tl::unexpected(Failure{FailureKind::kDevice, "spool:" + folder_,
                                  "no spool is here; printing to it makes one"});
  }
  Result<File> file = open_counter(folder_, 0);
  if (!file) return file;
  if (auto locked = wait_for(*file); !locked) return tl::unexpected(locked.error());
  recover();
  return file;
}

// Others hold the lock for as long as they change a job's place, which is soon over, unless they
// were stopped. EINTR is a person who waits no longer.
Result<void> Spool::wait_for(const File& counter) const {
  constexpr int kTries = 500;
  constexpr useconds_t kPause_us = 2000;
  for (int i = 0; i < kTries; ++i) {
    if (flock(counter.fd(), LOCK_EX | LOCK_NB) == 0) return {};
    if (errno != EWOULDBLOCK || usleep(kPause_us) != 0) {
      return tl::unexpected(system_failure(errno, folder_, "cannot lock it"));
    }
  }
  if (say_wait_) say_wait_(folder_ + ": waits for another process that holds the spool's lock");
  if (flock(counter.fd(), LOCK_EX) != 0) {
    return tl::unexpected(system_failure(errno, folder_, "cannot lock it"));
  }
  return {};
}

std::vector<std::string> Spool::ids(const std::string& place) const {
  std::vector<std::string> found;
  std::error_code error;
  for (fs::directory_iterator i(folder_ + "/" + place, error), end; !error && i != end;
       i.increment(error)) {
    std::string name = i->path().filename().string();
    if (place == "done") {
      if (!name.ends_with(".bjob")) continue;
      name.resize(name.size() - 5);
    }
    if (is_job_id(name)) found.push_back(std::move(name));
  }
  std::sort(found.begin(), found.end(),
            [](const std::string& a, const std::string& b) { return id_number(a) < id_number(b); });
  return found;
}

Result<std::string> Spool::new_id(const File& lock) const {
  std::array<char, 20> text{};
  const ssize_t size = pread(lock.fd(), text.data(), text.size(), 0);
  std::uint64_t last =
      id_number({text.data(), static_cast<std::size_t>(std::max<ssize_t>(size, 0))});
  // The counter alone would do, had nobody ever copied or cleaned a spool by hand.
  for (const char* place : {"incoming", "held", "done"}) {
    for (const std::string& id : ids(place)) last = std::max(last, id_number(id));
  }
  const std::string next = std::to_string(last + 1);
  if (!is_job_id(next)) {
    return tl::unexpected(Failure{
        FailureKind::kDevice, folder_ + "/last-id",
        fmt::format("has no number left after {}; jobs of such numbers did not come from this "
                    "program: move them away and write the last right number here",
                    last)});
  }
  const ssize_t written = pwrite(lock.fd(), next.data(), next.size(), 0);
  if (written != static_cast<ssize_t>(next.size())) {
    // A disk that fills up in the middle takes a part, and says nothing.
    return tl::unexpected(
        system_failure(written < 0 ? errno : ENOSPC, folder_ + "/last-id", "cannot write"));
  }
  if (auto done = sync_file(lock, folder_ + "/last-id"); !done) {
    return tl::unexpected(done.error());
  }
  return next;
}

Result<void> Spool::hold(const std::string& id) const {
  return move_synced(incoming(id), held(id));
}

Result<void> Spool::unhold(const std::string& id) const {
  return move_synced(held(id), incoming(id));
}

Result<void> Spool::file_away(const std::string& id) const {
  if (auto done = move_synced(incoming(id) + "/journal", done_journal(id)); !done) return done;
  return remove(incoming(id));
}

Result<void> Spool::remove(const std::string& job_folder) const {
  for (const char* name : {"/journal", "/job.part", "/cancel"}) {
    if (unlink((job_folder + name).c_str()) != 0 && errno != ENOENT) {
      return tl::unexpected(system_failure(errno, job_folder + name, "cannot remove it"));
    }
  }
  if (rmdir(job_folder.c_str()) != 0) {
    return tl::unexpected(system_failure(errno, job_folder, "cannot remove it"));
  }
  return sync_folder(folder_of(job_folder));
}

// One job that cannot be put in order, by the rights of its files say, must not block the others:
// it stays where it is.
void Spool::recover() const {
  for (const std::string& id : ids("incoming")) {
    const std::string folder = incoming(id);
    const std::string journal_path = folder + "/journal";
    // A sender starts and ends a job with the spool's lock, which is ours: a job without a whole
    // line in its journal has a sender that died before start returned, or a job that was removed.
    if (!has_line(journal_path)) {
      static_cast<void>(remove(folder));
      continue;
    }
    const Result<std::optional<Journal>> journal = Journal::open(journal_path);
    if (!journal || !journal->has_value()) continue;  // its sender lives
    if (path_exists(done_job(id))) {
      static_cast<void>(file_away(id));
    } else if (path_exists(folder + "/cancel")) {
      static_cast<void>(remove(folder));
    } else {
      static_cast<void>(hold(id));
    }
  }
  for (const std::string& id : ids("held")) {
    if (!has_line(held(id) + "/journal")) static_cast<void>(remove(held(id)));
  }
}

Result<std::vector<JobStatus>> Spool::jobs() const {
  std::vector<JobStatus> all;
  const auto add = [&all](const std::string& id, JobState state, const std::string& journal_path) {
    const Result<JournalState> journal = Journal::peek(journal_path);
    JobStatus status{id, state, 0, 0, "", "", ""};
    if (journal && journal->started) {
      status.layer_count = journal->layer_count;
      status.acknowledged = journal->acknowledged;
      status.name = journal->name;
      status.source = journal->source;
      if (state == JobState::kHeld) {
        status.reason = journal->held.empty() ? "its sender died" : journal->held;
      }
    } else {
      status.reason = "its journal is damaged: cancel it and print again";
    }
    all.push_back(std::move(status));
  };
  for (const std::string& id : ids("incoming")) {
    add(id, JobState::kIncoming, incoming(id) + "/journal");
  }
  for (const std::string& id : ids("held")) add(id, JobState::kHeld, held(id) + "/journal");
  for (const std::string& id : ids("done")) {
    add(id, JobState::kDone, done_journal(id));
    if (path_exists(done_journal(id))) continue;
    // A death between the two renames of the end, or somebody's tidying: the job itself is whole.
    const Result<JobReader> job = JobReader::open(done_job(id));
    const int layers = job ? static_cast<int>(job->layers(RecordKind::kMask).size()) : 0;
    all.back() = {
        id, JobState::kDone, layers, layers, "", "", job ? job->damage() : job.error().what};
  }
  std::sort(all.begin(), all.end(), [](const JobStatus& a, const JobStatus& b) {
    return id_number(a.id) < id_number(b.id);
  });
  return all;
}

std::string Spool::id_at_device(std::uint64_t number) const {
  for (const char* place : {"incoming", "held"}) {
    for (const std::string& id : ids(place)) {
      const auto journal = Journal::peek(fmt::format("{}/{}/{}/journal", folder_, place, id));
      if (journal && journal->key == number) return id;
    }
  }
  return "";
}

}  // namespace binderjet
