// SPDX-License-Identifier: GPL-3.0-or-later
// The journals live in a spool of their own (spool.h). Its job files hold the header and no layer:
// the layers are in the printer, and what is still to come is read from the job or computed again.
#include "transport/printer/printer_backend.h"

#include <fmt/core.h>
#include <sys/random.h>
#include <unistd.h>

#include <atomic>
#include <charconv>
#include <future>
#include <optional>
#include <thread>
#include <utility>

#include "transport/printer/printer_job.h"
#include "transport/spool/spooled_job.h"

namespace binderjet {
namespace {

using Clock = std::chrono::steady_clock;

// A cancel answers within a second: this much of it is for telling the printer.
constexpr auto kCancelTime = std::chrono::milliseconds(500);
constexpr auto kCancelLimit = std::chrono::milliseconds(800);

class PrinterBackend : public Backend {
 public:
  explicit PrinterBackend(PrinterAccess access)
      : access_(std::move(access)), journals_(access_.journals, access_.say_wait) {}
  ~PrinterBackend() override { stop("its sender stopped"); }

  Result<std::string> start(const JobTicket& ticket) override;
  Result<int> resume(const std::string& id, const JobTicket& ticket) override;
  Result<int> send(int layer, std::span<const std::byte> records) override;
  Result<void> end() override;
  Result<std::vector<JobStatus>> status() override;
  Result<void> cancel(const std::string& id) override;
  Result<DeviceStatus> device() override;
  Result<std::string> header(const std::string& id) override;

 private:
  Failure fault(FailureKind kind, std::string what) const {
    return {kind, access_.uri, std::move(what)};
  }
  Result<std::unique_ptr<PrinterJob>> connect(const std::string& uri, PrinterSession::Check check,
                                              PrinterJob::Keep keep);
  Result<void> connect_for_job(const std::string& uri);
  Result<void> check_there() const;
  Result<void> check_wanted();
  Result<void> make_way(std::uint64_t number);
  Result<std::string> cancelled_folder() const;
  // Holds the job, says where and why, and hands the fault on.
  tl::unexpected<Failure> stopped(Failure fault);
  void stop(const std::string& reason);
  void forget_job();

  PrinterAccess access_;
  Spool journals_;
  std::optional<SpooledJob> job_;  // the job being sent, as the spool's journal has it
  bool cancelled_ = false;
  std::unique_ptr<PrinterJob> job_at_printer_;  // the job being sent, as the printer has it
};

// A Fault if somebody wants the job to stop: by a mark in its folder, or a signal to this process.
Result<void> PrinterBackend::check_wanted() {
  if (job_ && cancel_asked(journals_, *job_)) {
    cancelled_ = true;
    return tl::unexpected(
        fault(FailureKind::kInterrupted, fmt::format("job {} was cancelled", job_->id)));
  }
  if (access_.stop_asked && access_.stop_asked()) {
    return tl::unexpected(fault(FailureKind::kInterrupted, "interrupted"));
  }
  return {};
}

Result<std::unique_ptr<PrinterJob>> PrinterBackend::connect(const std::string& uri,
                                                            PrinterSession::Check check,
                                                            PrinterJob::Keep keep) {
  Result<std::unique_ptr<PrinterLink>> link = access_.open(uri);
  if (!link) return tl::unexpected(link.error());
  auto session =
      std::make_unique<PrinterSession>(std::move(*link), access_.patience, std::move(check));
  return std::make_unique<PrinterJob>(std::move(session), access_.patience, std::move(keep));
}

Result<void> PrinterBackend::connect_for_job(const std::string& uri) {
  auto job = connect(
      uri, [this] { return check_wanted(); },
      [this](int layers, std::uint64_t digest) {
        return job_ ? job_->journal.acknowledge(layers, 0, digest) : Result<void>();
      });
  if (!job) return tl::unexpected(job.error());
  job_at_printer_ = std::move(*job);
  const auto welcome = job_at_printer_->greet();
  if (welcome) return {};
  job_at_printer_.reset();
  return tl::unexpected(welcome.error());
}

Result<void> PrinterBackend::check_there() const {
  return access_.must_be_there ? access_.must_be_there() : Result<void>();
}

void PrinterBackend::stop(const std::string& reason) {
  job_at_printer_.reset();
  if (job_) hold_job(journals_, *std::exchange(job_, std::nullopt), reason);
}

// A job that somebody cancelled, or that never began, is removed by its sender, who alone knows
// that nobody writes to it.
void PrinterBackend::forget_job() {
  const SpooledJob job = *std::exchange(job_, std::nullopt);  // check_wanted() no longer looks
  const std::uint64_t number = job.journal.state().key;
  cancelled_ = false;
  bool told = false;
  if (job_at_printer_)
    told = job_at_printer_->cancel(number, Clock::now() + kCancelTime).has_value();
  job_at_printer_.reset();
  if (const Result<File> lock = journals_.lock()) {
    if (!told) {
      if (const auto folder = cancelled_folder()) {
        static_cast<void>(
            open_file(fmt::format("{}/{:016x}", *folder, number), O_WRONLY | O_CREAT));
      }
    }
    static_cast<void>(journals_.remove(journals_.incoming(job.id)));
  }
}

tl::unexpected<Failure> PrinterBackend::stopped(Failure fault) {
  const int layer = job_at_printer_ ? job_at_printer_->acknowledged() : job_->next;
  fault.where = fmt::format("{}: layer {} of {}", fault.where.empty() ? access_.uri : fault.where,
                            layer, job_->layer_count());
  if (cancelled_) {
    forget_job();
  } else {
    stop(fault.what);
  }
  return tl::unexpected(std::move(fault));
}

Result<std::string> PrinterBackend::cancelled_folder() const {
  const std::string folder = journals_.folder() + "/cancelled";
  if (auto done = make_folder(folder); !done) return tl::unexpected(done.error());
  return folder;
}

// The printer holds another job. One that was cancelled here while the printer could not be told
// goes now; any other is somebody's unfinished print.
Result<void> PrinterBackend::make_way(std::uint64_t number) {
  const std::string mark = fmt::format("{}/cancelled/{:016x}", journals_.folder(), number);
  if (path_exists(mark)) {
    auto done = job_at_printer_->cancel(number, Clock::now() + access_.patience);
    if (done) unlink(mark.c_str());
    return done;
  }
  if (const std::string id = journals_.id_at_device(number); !id.empty()) {
    return tl::unexpected(
        fault(FailureKind::kDevice,
              fmt::format("the printer holds the unfinished job {0}: binderjet resume {0} --to "
                          "{1}, or binderjet cancel {0} --to {1}",
                          id, access_.uri)));
  }
  return tl::unexpected(
      fault(FailureKind::kDevice, fmt::format("the printer holds an unfinished job from elsewhere; "
                                              "binderjet cancel {:016x} --to {} makes it forget it",
                                              number, access_.uri)));
}

Result<std::string> PrinterBackend::start(const JobTicket& ticket) {
  // First the printer: a job for a printer that is not there shall not be left behind.
  if (auto done = connect_for_job(access_.uri); !done) return tl::unexpected(done.error());
  if (auto done = journals_.create(); !done) return tl::unexpected(done.error());
  std::uint64_t number = 0;
  while (number == 0) {
    if (getrandom(&number, sizeof number, 0) != sizeof number) {
      return tl::unexpected(fault(FailureKind::kDevice, "the system gives no random numbers"));
    }
  }
  {
    const Result<File> lock = journals_.lock();
    if (!lock) return tl::unexpected(lock.error());
    Result<SpooledJob> job =
        start_job(journals_, *lock, ticket, {job_at_printer_->printer_uri(), number});
    if (!job) return tl::unexpected(job.error());
    job_ = *std::move(job);
  }
  const std::string id = job_->id;
  Result<void> started = job_at_printer_->start(number, ticket.layer_count, ticket.header);
  if (!started && job_at_printer_->in_the_way() != 0 && job_at_printer_->in_the_way() != number) {
    started = make_way(job_at_printer_->in_the_way());
    if (started) started = job_at_printer_->start(number, ticket.layer_count, ticket.header);
  }
  if (!started) {
    // Nobody has been told of the job yet, so nobody could resume it.
    forget_job();
    return tl::unexpected(started.error());
  }
  return id;
}

Result<int> PrinterBackend::resume(const std::string& id, const JobTicket& ticket) {
  if (auto there = check_there(); !there) return tl::unexpected(there.error());
  {
    const Result<File> lock = journals_.lock();
    if (!lock) return tl::unexpected(lock.error());
    Result<SpooledJob> job = resume_job(journals_, id, ticket, LayersAre::kAtDevice, access_.uri);
    if (!job) return tl::unexpected(job.error());
    job_ = *std::move(job);
  }
  const JournalState state = job_->journal.state();
  // The same printer, whatever else is plugged in by now.
  if (auto done = connect_for_job(state.to); !done) return stopped(done.error());
  Result<int> first = job_at_printer_->resume(state.key, state.layer_count, ticket.header,
                                              state.acknowledged, state.digest);
  if (!first) return stopped(first.error());
  job_->next = *first;
  return first;
}

Result<int> PrinterBackend::send(int layer, std::span<const std::byte> records) {
  if (!job_) return tl::unexpected(fault(FailureKind::kBadInput, "no job was started"));
  if (auto due = check_next(*job_, layer, access_.uri); !due) return stopped(due.error());
  if (auto wanted = check_wanted(); !wanted) return stopped(wanted.error());
  ++job_->next;
  if (auto done = job_at_printer_->send(layer, records); !done) return stopped(done.error());
  return job_at_printer_->acknowledged();
}

Result<void> PrinterBackend::end() {
  if (!job_) return tl::unexpected(fault(FailureKind::kBadInput, "no job was started"));
  if (auto whole = check_all_came(*job_, access_.uri); !whole) return stopped(whole.error());
  if (auto done = job_at_printer_->end(); !done) return stopped(done.error());
  job_at_printer_.reset();
  return finish_job(journals_, *std::exchange(job_, std::nullopt));
}

Result<std::vector<JobStatus>> PrinterBackend::status() {
  if (auto there = check_there(); !there) return tl::unexpected(there.error());
  if (!path_exists(journals_.folder())) return std::vector<JobStatus>();
  const Result<File> lock = journals_.lock();
  if (!lock) return tl::unexpected(lock.error());
  return journals_.jobs();
}

Result<void> PrinterBackend::cancel(const std::string& id) {
  if (auto there = check_there(); !there) return there;
  std::string uri = access_.uri;
  std::uint64_t number = 0;
  if (id.size() == 16 &&
      std::from_chars(id.data(), id.data() + 16, number, 16).ptr == id.data() + 16) {
    // A job of another computer, by its number.
  } else {
    if (!path_exists(journals_.folder())) return tl::unexpected(unknown_job(access_.uri, id));
    const Result<File> lock = journals_.lock();
    if (!lock) return tl::unexpected(lock.error());
    const Result<bool> asked = ask_cancel(journals_, id, access_.uri);
    if (!asked) return tl::unexpected(asked.error());
    if (*asked) return {};
    if (const auto journal = Journal::peek(journals_.held(id) + "/journal")) {
      number = journal->key;
      if (!journal->to.empty()) uri = journal->to;
    }
    // From here on the job is cancelled, whether the printer hears it now or before its next job.
    if (const auto folder = cancelled_folder()) {
      static_cast<void>(open_file(fmt::format("{}/{:016x}", *folder, number), O_WRONLY | O_CREAT));
    }
    if (auto done = journals_.remove(journals_.held(id)); !done) return done;
  }
  // A printer may hang in any call of the system. The caller does not wait for that: the thread
  // keeps all it needs alive, and at worst ends with the process.
  const auto told = std::make_shared<std::promise<bool>>();
  std::future<bool> answer = told->get_future();
  const auto sender = std::make_shared<PrinterBackend>(access_);
  std::thread([sender, told, uri, number] {
    const auto until = Clock::now() + kCancelTime;
    bool heard = false;
    try {
      auto job = sender->connect(
          uri, [] { return Result<void>(); }, [](int, std::uint64_t) { return Result<void>(); });
      heard = job && (*job)->cancel(number, until).has_value();
    } catch (const std::exception&) {  // out of memory or of threads: the printer was not told
    }
    told->set_value(heard);
  }).detach();
  const bool heard = answer.wait_for(kCancelLimit) == std::future_status::ready && answer.get();
  if (heard) {
    unlink(fmt::format("{}/cancelled/{:016x}", journals_.folder(), number).c_str());
  } else if (id.size() == 16) {
    return tl::unexpected(fault(FailureKind::kDevice, "the printer could not be told"));
  }
  return {};
}

Result<DeviceStatus> PrinterBackend::device() {
  auto job = connect(
      access_.uri, [this] { return check_wanted(); },
      [](int, std::uint64_t) { return Result<void>(); });
  if (!job) return tl::unexpected(job.error());
  const auto welcome = (*job)->greet();
  if (!welcome) return tl::unexpected(welcome.error());
  const auto status = (*job)->status(Clock::now() + access_.patience);
  if (!status) return tl::unexpected(status.error());
  DeviceStatus device{(*job)->printer_uri(), welcome->name, protocol::state_word(status->state)};
  for (const std::string& reason : status->reasons) device.description += ", " + reason;
  for (const protocol::Supply& supply : status->supplies) {
    device.description += fmt::format(", {} ", supply.name);
    device.description +=
        supply.level_percent < 0 ? "unknown" : fmt::format("{} %", supply.level_percent);
  }
  return device;
}

Result<std::string> PrinterBackend::header(const std::string& id) {
  if (auto there = check_there(); !there) return tl::unexpected(there.error());
  return held_header(journals_, id, access_.uri);
}

}  // namespace

std::unique_ptr<Backend> make_printer_backend(PrinterAccess access) {
  return std::make_unique<PrinterBackend>(std::move(access));
}

Result<std::chrono::milliseconds> take_patience(std::string& uri) {
  constexpr std::string_view kPatience = "?patience_s=";
  const std::size_t mark = uri.rfind(kPatience);
  if (mark == std::string::npos) return std::chrono::milliseconds(30000);
  const char* begin = uri.data() + mark + kPatience.size();
  const char* end = uri.data() + uri.size();
  double seconds = 0;
  if (std::from_chars(begin, end, seconds).ptr != end || !(seconds >= 0.1 && seconds <= 86400)) {
    return tl::unexpected(Failure{FailureKind::kBadInput, uri,
                                  "patience_s is a number of seconds from 0.1 to 86400"});
  }
  uri.erase(mark);
  return std::chrono::milliseconds(static_cast<int>(seconds * 1000));
}

}  // namespace binderjet
