// SPDX-License-Identifier: GPL-3.0-or-later
// usb: takes jobs to a printer and keeps a journal of each, so that another process can go on where
// one was killed.
//
// The journals live in a spool of their own (spool.h). Its job files hold the header and no layer:
// the layers are in the printer, and what is still to come is read from the job or computed again.
#include "transport/usb/usb_backend.h"

#include <fmt/core.h>
#include <sys/random.h>
#include <unistd.h>

#include <atomic>
#include <charconv>
#include <future>
#include <optional>
#include <thread>
#include <utility>

#include "transport/spool/spooled_job.h"
#include "transport/usb/usb_job.h"

namespace binderjet {
namespace {

using Clock = std::chrono::steady_clock;

// A cancel answers within a second: this much of it is for telling the printer.
constexpr auto kCancelTime = std::chrono::milliseconds(500);
constexpr auto kCancelLimit = std::chrono::milliseconds(800);

std::vector<UsbModel> models_of(const BackendOptions& options) {
  std::vector<UsbModel> models = known_usb_models();
  for (const std::string& text : options.usb_models) {
    if (const auto model = parse_usb_model_words(text)) models.push_back(*model);
  }
  return models;
}

class UsbBackend : public Backend {
 public:
  UsbBackend(std::string text, UsbUri uri, BackendOptions options)
      : text_(std::move(text)),
        uri_(std::move(uri)),
        options_(std::move(options)),
        journals_(options_.state_folder) {}
  ~UsbBackend() override { stop("its sender stopped"); }

  Result<std::string> start(const JobTicket& ticket) override;
  Result<int> resume(const std::string& id, const JobTicket& ticket) override;
  Result<int> send(int layer, std::span<const std::byte> records) override;
  Result<void> end() override;
  Result<std::vector<JobStatus>> status() override;
  Result<void> cancel(const std::string& id) override;
  Result<DeviceStatus> device() override;
  Result<std::string> header(const std::string& id) override;

 private:
  Failure fault(FailureKind kind, std::string what) const { return {kind, text_, std::move(what)}; }
  Result<std::unique_ptr<UsbJob>> connect(const UsbUri& uri, const std::string& text,
                                          UsbSession::Check check, UsbJob::Keep keep);
  Result<void> connect_for_job(const UsbUri& uri, const std::string& text);
  Result<void> check_wanted();
  Result<void> make_way(std::uint64_t number);
  Result<std::string> cancelled_folder() const;
  // Holds the job, says where and why, and hands the fault on.
  tl::unexpected<Failure> stopped(Failure fault);
  void stop(const std::string& reason);
  void forget_cancelled();

  std::string text_;
  UsbUri uri_;
  BackendOptions options_;
  Spool journals_;
  std::optional<SpooledJob> job_;  // the job being sent, as the spool's journal has it
  bool cancelled_ = false;
  std::unique_ptr<UsbJob> job_at_printer_;  // the job being sent, as the printer has it
};

// A Fault if somebody wants the job to stop: by a mark in its folder, or a signal to this process.
Result<void> UsbBackend::check_wanted() {
  if (job_ && cancel_asked(journals_, *job_)) {
    cancelled_ = true;
    return tl::unexpected(
        fault(FailureKind::kInterrupted, fmt::format("job {} was cancelled", job_->id)));
  }
  if (options_.stop_asked && options_.stop_asked()) {
    return tl::unexpected(fault(FailureKind::kInterrupted, "interrupted"));
  }
  return {};
}

Result<std::unique_ptr<UsbJob>> UsbBackend::connect(const UsbUri& uri, const std::string& text,
                                                    UsbSession::Check check, UsbJob::Keep keep) {
  Result<UsbContext> context = open_usb_context(text);
  if (!context) return tl::unexpected(context.error());
  Result<OpenPrinter> printer = open_printer(context->get(), uri, text, models_of(options_));
  if (!printer) return tl::unexpected(printer.error());
  auto link = std::make_unique<UsbLink>(std::move(*context), std::move(*printer));
  auto session = std::make_unique<UsbSession>(std::move(link), uri.patience, std::move(check));
  return std::make_unique<UsbJob>(std::move(session), uri.patience, std::move(keep));
}

Result<void> UsbBackend::connect_for_job(const UsbUri& uri, const std::string& text) {
  auto job = connect(
      uri, text, [this] { return check_wanted(); },
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

void UsbBackend::stop(const std::string& reason) {
  job_at_printer_.reset();
  if (job_) hold_job(journals_, *std::exchange(job_, std::nullopt), reason);
}

// A job that somebody cancelled is removed by its sender, who alone knows that nobody writes to it.
void UsbBackend::forget_cancelled() {
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

tl::unexpected<Failure> UsbBackend::stopped(Failure fault) {
  const int layer = job_at_printer_ ? job_at_printer_->acknowledged() : job_->next;
  fault.where = fmt::format("{}: layer {} of {}", fault.where.empty() ? text_ : fault.where, layer,
                            job_->layer_count());
  if (cancelled_) {
    forget_cancelled();
  } else {
    stop(fault.what);
  }
  return tl::unexpected(std::move(fault));
}

Result<std::string> UsbBackend::cancelled_folder() const {
  const std::string folder = journals_.folder() + "/cancelled";
  if (auto done = make_folder(folder); !done) return tl::unexpected(done.error());
  return folder;
}

// The printer holds another job. One that was cancelled here while the printer could not be told
// goes now; any other is somebody's unfinished print.
Result<void> UsbBackend::make_way(std::uint64_t number) {
  const std::string mark = fmt::format("{}/cancelled/{:016x}", journals_.folder(), number);
  if (path_exists(mark)) {
    auto done = job_at_printer_->cancel(number, Clock::now() + uri_.patience);
    if (done) unlink(mark.c_str());
    return done;
  }
  if (const auto jobs = status()) {
    for (const JobStatus& job : *jobs) {
      const auto journal = Journal::peek(journals_.held(job.id) + "/journal");
      if (!journal || journal->key != number) continue;
      return tl::unexpected(
          fault(FailureKind::kDevice,
                fmt::format("the printer holds the unfinished job {0}: binderjet resume {0} --to "
                            "{1}, or binderjet cancel {0} --to {1}",
                            job.id, text_)));
    }
  }
  return tl::unexpected(
      fault(FailureKind::kDevice, fmt::format("the printer holds an unfinished job from elsewhere; "
                                              "binderjet cancel {:016x} --to {} makes it forget it",
                                              number, text_)));
}

Result<std::string> UsbBackend::start(const JobTicket& ticket) {
  // First the printer: a job for a printer that is not there shall not be left behind.
  if (auto done = connect_for_job(uri_, text_); !done) return tl::unexpected(done.error());
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
        start_job(journals_, *lock, ticket, {job_at_printer_->printer().uri, number});
    if (!job) return tl::unexpected(job.error());
    job_ = *std::move(job);
  }
  const std::string id = job_->id;
  Result<void> started = job_at_printer_->start(number, ticket.layer_count, ticket.header);
  if (!started && job_at_printer_->in_the_way() != 0 && job_at_printer_->in_the_way() != number) {
    // Until the way is free the job has not begun: nothing of it is kept.
    started = make_way(job_at_printer_->in_the_way());
    if (started) started = job_at_printer_->start(number, ticket.layer_count, ticket.header);
    if (!started) {
      const Failure why = started.error();
      const Result<File> lock = journals_.lock();
      job_.reset();
      job_at_printer_.reset();
      if (lock) static_cast<void>(journals_.remove(journals_.incoming(id)));
      return tl::unexpected(why);
    }
  }
  if (!started) return stopped(started.error());
  return id;
}

Result<int> UsbBackend::resume(const std::string& id, const JobTicket& ticket) {
  {
    const Result<File> lock = journals_.lock();
    if (!lock) return tl::unexpected(lock.error());
    Result<SpooledJob> job = resume_job(journals_, id, ticket, text_);
    if (!job) return tl::unexpected(job.error());
    job_ = *std::move(job);
  }
  const JournalState state = job_->journal.state();
  // The same printer, whatever else is plugged in by now.
  Result<UsbUri> same = parse_usb_uri(state.to);
  if (!same) return stopped(same.error());
  same->patience = uri_.patience;
  if (auto done = connect_for_job(*same, state.to); !done) return stopped(done.error());
  Result<int> first = job_at_printer_->resume(state.key, state.layer_count, ticket.header,
                                              state.acknowledged, state.digest);
  if (!first) return stopped(first.error());
  job_->next = *first;
  return first;
}

Result<int> UsbBackend::send(int layer, std::span<const std::byte> records) {
  if (!job_) return tl::unexpected(fault(FailureKind::kBadInput, "no job was started"));
  if (auto due = check_next(*job_, layer, text_); !due) return stopped(due.error());
  if (auto wanted = check_wanted(); !wanted) return stopped(wanted.error());
  ++job_->next;
  if (auto done = job_at_printer_->send(layer, records); !done) return stopped(done.error());
  return job_at_printer_->acknowledged();
}

Result<void> UsbBackend::end() {
  if (!job_) return tl::unexpected(fault(FailureKind::kBadInput, "no job was started"));
  if (auto whole = check_all_came(*job_, text_); !whole) return stopped(whole.error());
  if (auto done = job_at_printer_->end(); !done) return stopped(done.error());
  job_at_printer_.reset();
  return finish_job(journals_, *std::exchange(job_, std::nullopt));
}

Result<std::vector<JobStatus>> UsbBackend::status() {
  if (!path_exists(journals_.folder())) return std::vector<JobStatus>();
  const Result<File> lock = journals_.lock();
  if (!lock) return tl::unexpected(lock.error());
  return journals_.jobs();
}

Result<void> UsbBackend::cancel(const std::string& id) {
  UsbUri uri = uri_;
  std::string text = text_;
  std::uint64_t number = 0;
  if (id.size() == 16 &&
      std::from_chars(id.data(), id.data() + 16, number, 16).ptr == id.data() + 16) {
    // A job of another computer, by its number.
  } else {
    if (!path_exists(journals_.folder())) return tl::unexpected(unknown_job(text_, id));
    const Result<File> lock = journals_.lock();
    if (!lock) return tl::unexpected(lock.error());
    const Result<bool> asked = ask_cancel(journals_, id, text_);
    if (!asked) return tl::unexpected(asked.error());
    if (*asked) return {};
    if (const auto journal = Journal::peek(journals_.held(id) + "/journal")) {
      number = journal->key;
      if (const auto same = parse_usb_uri(journal->to)) {
        uri = *same;
        text = journal->to;
      }
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
  const auto link = std::make_shared<UsbBackend>(text, uri, options_);
  std::thread([link, told, uri, text, number] {
    const auto until = Clock::now() + kCancelTime;
    auto job = link->connect(
        uri, text, [] { return Result<void>(); },
        [](int, std::uint64_t) { return Result<void>(); });
    told->set_value(job && (*job)->cancel(number, until).has_value());
  }).detach();
  const bool heard = answer.wait_for(kCancelLimit) == std::future_status::ready && answer.get();
  if (heard) {
    unlink(fmt::format("{}/cancelled/{:016x}", journals_.folder(), number).c_str());
  } else if (id.size() == 16) {
    return tl::unexpected(fault(FailureKind::kDevice, "the printer could not be told"));
  }
  return {};
}

Result<DeviceStatus> UsbBackend::device() {
  auto job = connect(
      uri_, text_, [this] { return check_wanted(); },
      [](int, std::uint64_t) { return Result<void>(); });
  if (!job) return tl::unexpected(job.error());
  const auto welcome = (*job)->greet();
  if (!welcome) return tl::unexpected(welcome.error());
  const auto status = (*job)->status(Clock::now() + uri_.patience);
  if (!status) return tl::unexpected(status.error());
  DeviceStatus device{(*job)->printer().uri, welcome->name, protocol::state_word(status->state)};
  for (const std::string& reason : status->reasons) device.description += ", " + reason;
  for (const protocol::Supply& supply : status->supplies) {
    device.description += fmt::format(", {} ", supply.name);
    device.description +=
        supply.level_percent < 0 ? "unknown" : fmt::format("{} %", supply.level_percent);
  }
  return device;
}

Result<std::string> UsbBackend::header(const std::string& id) {
  return held_header(journals_, id, text_);
}

}  // namespace

Result<std::unique_ptr<Backend>> make_usb_backend(const std::string& uri,
                                                  const BackendOptions& options) {
  Result<UsbUri> parsed = parse_usb_uri(uri);
  if (!parsed) return tl::unexpected(parsed.error());
  return std::make_unique<UsbBackend>(uri, std::move(*parsed), options);
}

Result<std::vector<DeviceStatus>> list_usb_devices(const BackendOptions& options) {
  const auto printers = list_printers(models_of(options));
  if (!printers) return tl::unexpected(printers.error());
  std::vector<DeviceStatus> devices;
  for (const SeenPrinter& printer : *printers) {
    devices.push_back({printer.uri, printer.fault.empty() ? printer.description : printer.fault,
                       printer.fault.empty() ? "connected" : "unavailable"});
  }
  return devices;
}

bool wait_for_usb_device(const std::string& uri, const BackendOptions& options, double seconds) {
  const auto parsed = parse_usb_uri(uri);
  if (!parsed) return false;
  return wait_for_printer(*parsed, models_of(options),
                          std::chrono::milliseconds(static_cast<int>(seconds * 1000)),
                          [&] { return options.stop_asked && options.stop_asked(); });
}

}  // namespace binderjet
