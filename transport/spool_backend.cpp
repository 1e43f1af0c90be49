// SPDX-License-Identifier: GPL-3.0-or-later
// spool:DIR takes jobs as a printer does: what it acknowledged survives the sender and the power.
#include <fmt/core.h>
#include <sys/statvfs.h>

#include <chrono>
#include <optional>
#include <utility>

#include "transport/backend.h"
#include "transport/held_job.h"
#include "transport/job_file.h"
#include "transport/journal.h"
#include "transport/spool.h"

namespace binderjet {
namespace {

using Clock = std::chrono::steady_clock;

// A sync costs up to some 10 ms on a disk that turns. Layers that come fast share one; one that
// comes after a pause is acknowledged at once.
constexpr int kBatchLayers = 64;
constexpr std::uint64_t kBatchBytes = std::uint64_t{8} << 20;
constexpr auto kBatchTime = std::chrono::milliseconds(50);

class SpoolBackend : public Backend {
 public:
  explicit SpoolBackend(std::string folder) : spool_(std::move(folder)) {}
  ~SpoolBackend() override { stop("its sender stopped"); }

  Result<std::string> start(const JobTicket& ticket) override;
  Result<int> resume(const std::string& id, const JobTicket& ticket) override;
  Result<int> send(int layer, std::span<const std::byte> records) override;
  Result<void> end() override;
  Result<std::vector<JobStatus>> status() override;
  Result<void> cancel(const std::string& id) override;
  Result<DeviceStatus> device() override;
  Result<std::string> header(const std::string& id) override;

 private:
  std::string where() const { return "spool:" + spool_.folder(); }
  Fault fault(FaultKind kind, std::string what) const { return {kind, where(), std::move(what)}; }
  Result<void> open_job(const std::string& id, const JobTicket& ticket);
  Result<void> check_wanted();
  Result<void> acknowledge();
  // Holds the job, says why, and hands the fault on.
  tl::unexpected<Fault> stopped(Fault fault);
  void stop(const std::string& reason);
  void close();

  Spool spool_;
  std::string id_;  // of the job being sent, or empty
  int layer_count_ = 0;
  int next_ = 0;  // the layer that comes next
  std::optional<JobWriter> writer_;
  std::optional<Journal> journal_;
  Clock::time_point last_sync_;
};

void SpoolBackend::close() {
  id_.clear();
  writer_.reset();
  journal_.reset();
}

void SpoolBackend::stop(const std::string& reason) {
  if (id_.empty()) return;
  const Result<File> lock = spool_.lock();
  // A full disk may refuse the line; the folder's place says the same.
  if (journal_) static_cast<void>(journal_->held(reason));
  // Should this fail too, the next process that looks finds a job without a sender and holds it.
  if (lock) static_cast<void>(spool_.hold(id_));
  close();
}

tl::unexpected<Fault> SpoolBackend::stopped(Fault fault) {
  stop(fault.what);
  return tl::unexpected(std::move(fault));
}

Result<void> SpoolBackend::open_job(const std::string& id, const JobTicket& ticket) {
  const std::string folder = spool_.incoming(id);
  if (auto done = make_folder(folder); !done) return done;
  Result<JobWriter> writer =
      JobWriter::create_kept(folder + "/job.part", spool_.done_job(id), ticket.header);
  if (!writer) return tl::unexpected(writer.error());
  if (auto done = writer->sync(); !done) return done;
  JournalState state;
  state.layer_count = ticket.layer_count;
  state.name = ticket.name;
  state.source = ticket.source;
  Result<Journal> journal = Journal::create(folder + "/journal", state);
  if (!journal) return tl::unexpected(journal.error());
  if (auto done = sync_folder(folder); !done) return done;
  if (auto done = sync_folder(folder_of(folder)); !done) return done;
  writer_ = std::move(*writer);
  journal_ = std::move(*journal);
  return {};
}

Result<std::string> SpoolBackend::start(const JobTicket& ticket) {
  if (auto done = spool_.create(); !done) return tl::unexpected(done.error());
  const Result<File> lock = spool_.lock();
  if (!lock) return tl::unexpected(lock.error());
  Result<std::string> id = spool_.new_id(*lock);
  if (!id) return id;
  if (auto done = open_job(*id, ticket); !done) {
    static_cast<void>(spool_.remove(spool_.incoming(*id)));
    return tl::unexpected(done.error());
  }
  id_ = *id;
  layer_count_ = ticket.layer_count;
  next_ = 0;
  last_sync_ = Clock::time_point();
  return id;
}

Result<int> SpoolBackend::resume(const std::string& id, const JobTicket& ticket) {
  const Result<File> lock = spool_.lock();
  if (!lock) return tl::unexpected(lock.error());
  Result<HeldJob> held = open_held_job(spool_, id, ticket, where());
  if (!held) return tl::unexpected(held.error());
  const JournalState state = held->journal.state();
  if (state.bytes == 0 && state.acknowledged > 0) {
    return tl::unexpected(
        cannot_resume(where(), id, "has a damaged journal: cancel it and print again"));
  }
  // Before its first acknowledgement a job is its header alone.
  const std::uint64_t bytes =
      state.bytes != 0 ? state.bytes : job_format::kPreambleBytes + ticket.header.size();
  Result<JobWriter> writer = JobWriter::reopen_kept(held->part, spool_.done_job(id), bytes);
  if (!writer) return tl::unexpected(writer.error());
  if (writer->last_layer() != state.acknowledged - 1) {
    return tl::unexpected(
        cannot_resume(where(), id, "has lost acknowledged layers: cancel it and print again"));
  }
  if (auto done = take_up(spool_, *held, *writer); !done) return tl::unexpected(done.error());
  writer_ = std::move(*writer);
  journal_ = std::move(held->journal);
  id_ = id;
  layer_count_ = state.layer_count;
  next_ = state.acknowledged;
  last_sync_ = Clock::time_point();
  return next_;
}

Result<void> SpoolBackend::acknowledge() {
  if (journal_->state().acknowledged == next_) return {};
  // First the layers, then the line that promises them.
  if (auto done = writer_->sync(); !done) return done;
  if (auto done = journal_->acknowledge(next_, writer_->bytes()); !done) return done;
  last_sync_ = Clock::now();
  return {};
}

// A job that somebody cancelled is removed by its sender, who alone knows that nobody writes to it.
Result<void> SpoolBackend::check_wanted() {
  if (!path_exists(spool_.incoming(id_) + "/cancel")) return {};
  const std::string what = fmt::format("job {} was cancelled before layer {}", id_, next_);
  if (const Result<File> lock = spool_.lock()) {
    static_cast<void>(spool_.remove(spool_.incoming(id_)));
  }
  close();
  return tl::unexpected(fault(FaultKind::kInterrupted, what));
}

Result<int> SpoolBackend::send(int layer, std::span<const std::byte> records) {
  if (id_.empty()) return tl::unexpected(fault(FaultKind::kBadInput, "no job was started"));
  if (auto wanted = check_wanted(); !wanted) return tl::unexpected(wanted.error());
  if (layer != next_ || layer >= layer_count_) {
    return stopped(fault(
        FaultKind::kBadInput,
        fmt::format("layer {} came where layer {} of {} was due", layer, next_, layer_count_)));
  }
  if (auto done = writer_->append(records); !done) return stopped(done.error());
  if (writer_->last_layer() != layer) {
    return stopped(
        fault(FaultKind::kBadInput, fmt::format("layer {} came without its records", layer)));
  }
  ++next_;
  if (next_ - journal_->state().acknowledged >= kBatchLayers ||
      writer_->bytes() - journal_->state().bytes >= kBatchBytes ||
      Clock::now() - last_sync_ >= kBatchTime) {
    if (auto done = acknowledge(); !done) return stopped(done.error());
  }
  return journal_->state().acknowledged;
}

Result<void> SpoolBackend::end() {
  if (id_.empty()) return tl::unexpected(fault(FaultKind::kBadInput, "no job was started"));
  if (next_ != layer_count_) {
    return stopped(fault(FaultKind::kBadInput,
                         fmt::format("the job ended before layer {} of {}", next_, layer_count_)));
  }
  if (auto wanted = check_wanted(); !wanted) return wanted;
  if (auto done = acknowledge(); !done) return stopped(done.error());
  {
    const Result<File> lock = spool_.lock();
    if (!lock) return tl::unexpected(lock.error());
    if (auto done = writer_->finish(); !done) {
      const Fault why = done.error();
      if (path_exists(spool_.done_job(id_))) {
        close();  // the job has its name, its folder could not be synced: recover() does the rest
        return tl::unexpected(why);
      }
      static_cast<void>(journal_->held(why.what));
      static_cast<void>(spool_.hold(id_));
      close();
      return tl::unexpected(why);
    }
    // The job is there; what is left of its folder the next process can put in order as well.
    static_cast<void>(spool_.file_away(id_));
  }
  close();
  return {};
}

Result<std::vector<JobStatus>> SpoolBackend::status() {
  const Result<File> lock = spool_.lock();
  if (!lock) return tl::unexpected(lock.error());
  return spool_.jobs();
}

Result<void> SpoolBackend::cancel(const std::string& id) {
  const Result<File> lock = spool_.lock();
  if (!lock) return tl::unexpected(lock.error());
  if (!is_job_id(id)) return tl::unexpected(unknown_job(where(), id));
  if (path_exists(spool_.held(id))) return spool_.remove(spool_.held(id));
  if (path_exists(spool_.incoming(id))) {
    const Result<File> mark = open_file(spool_.incoming(id) + "/cancel", O_WRONLY | O_CREAT);
    if (!mark) return tl::unexpected(mark.error());
    return {};
  }
  if (path_exists(spool_.done_job(id))) {
    return tl::unexpected(
        fault(FaultKind::kBadInput, fmt::format("job {} is done: too late to cancel it", id)));
  }
  return tl::unexpected(unknown_job(where(), id));
}

Result<DeviceStatus> SpoolBackend::device() {
  const Result<std::vector<JobStatus>> jobs = status();
  if (!jobs) return tl::unexpected(jobs.error());
  DeviceStatus device{"spool:" + spool_.folder(), "file spool", "idle"};
  for (const JobStatus& job : *jobs) {
    if (job.state == JobState::kIncoming) device.state = "processing";
  }
  struct statvfs disk = {};
  if (statvfs(spool_.folder().c_str(), &disk) == 0) {
    const double free_gb =
        static_cast<double>(disk.f_bavail) * static_cast<double>(disk.f_frsize) / 1e9;
    device.description = fmt::format("file spool, {} jobs, {:.1f} GB free", jobs->size(), free_gb);
  }
  return device;
}

Result<std::string> SpoolBackend::header(const std::string& id) {
  return held_header(spool_, id, where());
}

}  // namespace

std::unique_ptr<Backend> make_spool_backend(const std::string& folder) {
  return std::make_unique<SpoolBackend>(folder);
}

}  // namespace binderjet
