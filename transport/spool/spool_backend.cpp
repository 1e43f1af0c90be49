// SPDX-License-Identifier: GPL-3.0-or-later
// spool:DIR takes jobs as a printer does: what it acknowledged survives the sender and the power.
#include <fmt/core.h>
#include <sys/statvfs.h>

#include <chrono>
#include <optional>
#include <utility>

#include "transport/spool/spool.h"
#include "transport/spool/spooled_job.h"

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
  SpoolBackend(std::string folder, SayWait say_wait)
      : spool_(std::move(folder), std::move(say_wait)) {}
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
  Failure fault(FailureKind kind, std::string what) const {
    return {kind, where(), std::move(what)};
  }
  Result<void> check_wanted();
  Result<void> acknowledge();
  // Holds the job, says why, and hands the fault on.
  tl::unexpected<Failure> stopped(Failure fault);
  void stop(const std::string& reason);

  Spool spool_;
  std::optional<SpooledJob> job_;  // that is being sent
  Clock::time_point last_sync_;
};

void SpoolBackend::stop(const std::string& reason) {
  if (job_) hold_job(spool_, *std::exchange(job_, std::nullopt), reason);
}

tl::unexpected<Failure> SpoolBackend::stopped(Failure fault) {
  stop(fault.what);
  return tl::unexpected(std::move(fault));
}

Result<std::string> SpoolBackend::start(const JobTicket& ticket) {
  if (auto done = spool_.create(); !done) return tl::unexpected(done.error());
  const Result<File> lock = spool_.lock();
  if (!lock) return tl::unexpected(lock.error());
  Result<SpooledJob> job = start_job(spool_, *lock, ticket);
  if (!job) return tl::unexpected(job.error());
  job_ = *std::move(job);
  last_sync_ = Clock::time_point();
  return job_->id;
}

Result<int> SpoolBackend::resume(const std::string& id, const JobTicket& ticket) {
  const Result<File> lock = spool_.lock();
  if (!lock) return tl::unexpected(lock.error());
  Result<SpooledJob> job = resume_job(spool_, id, ticket, LayersAre::kInSpool, where());
  if (!job) return tl::unexpected(job.error());
  job_ = *std::move(job);
  last_sync_ = Clock::time_point();
  return job_->next;
}

Result<void> SpoolBackend::acknowledge() {
  if (job_->journal.state().acknowledged == job_->next) return {};
  // First the layers, then the line that promises them.
  if (auto done = job_->writer.sync(); !done) return done;
  if (auto done = job_->journal.acknowledge(job_->next, job_->writer.bytes()); !done) return done;
  last_sync_ = Clock::now();
  return {};
}

// A job that somebody cancelled is removed by its sender, who alone knows that nobody writes to it.
Result<void> SpoolBackend::check_wanted() {
  if (!cancel_asked(spool_, *job_)) return {};
  const std::string what =
      fmt::format("job {} was cancelled before layer {}", job_->id, job_->next);
  if (const Result<File> lock = spool_.lock()) {
    static_cast<void>(spool_.remove(spool_.incoming(job_->id)));
  }
  job_.reset();
  return tl::unexpected(fault(FailureKind::kInterrupted, what));
}

Result<int> SpoolBackend::send(int layer, std::span<const std::byte> records) {
  if (!job_) return tl::unexpected(fault(FailureKind::kBadInput, "no job was started"));
  if (auto wanted = check_wanted(); !wanted) return tl::unexpected(wanted.error());
  if (auto due = check_next(*job_, layer, where()); !due) return stopped(due.error());
  if (auto done = job_->writer.append(records); !done) return stopped(done.error());
  if (job_->writer.last_layer() != layer) {
    return stopped(
        fault(FailureKind::kBadInput, fmt::format("layer {} came without its records", layer)));
  }
  ++job_->next;
  const JournalState& kept = job_->journal.state();
  if (job_->next - kept.acknowledged >= kBatchLayers ||
      job_->writer.bytes() - kept.bytes >= kBatchBytes || Clock::now() - last_sync_ >= kBatchTime) {
    if (auto done = acknowledge(); !done) return stopped(done.error());
  }
  return kept.acknowledged;
}

Result<void> SpoolBackend::end() {
  if (!job_) return tl::unexpected(fault(FailureKind::kBadInput, "no job was started"));
  if (auto whole = check_all_came(*job_, where()); !whole) return stopped(whole.error());
  if (auto wanted = check_wanted(); !wanted) return wanted;
  if (auto done = acknowledge(); !done) return stopped(done.error());
  return finish_job(spool_, *std::exchange(job_, std::nullopt));
}

Result<std::vector<JobStatus>> SpoolBackend::status() {
  const Result<File> lock = spool_.lock();
  if (!lock) return tl::unexpected(lock.error());
  return spool_.jobs();
}

Result<void> SpoolBackend::cancel(const std::string& id) {
  const Result<File> lock = spool_.lock();
  if (!lock) return tl::unexpected(lock.error());
  const Result<bool> asked = ask_cancel(spool_, id, where());
  if (!asked) return tl::unexpected(asked.error());
  if (*asked) return {};
  return spool_.remove(spool_.held(id));
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

std::unique_ptr<Backend> make_spool_backend(const std::string& folder,
                                            const BackendOptions& options) {
  return std::make_unique<SpoolBackend>(folder, options.say_wait);
}

}  // namespace binderjet
