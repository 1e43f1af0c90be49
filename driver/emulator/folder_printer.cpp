// SPDX-License-Identifier: GPL-3.0-or-later
#include "driver/emulator/folder_printer.h"

#include <utility>

#include "driver/base/transport_errors.h"
#include "transport/base/file.h"
#include "transport/emulator/emulator_backend.h"
#include "transport/emulator/socket_server.h"
#include "transport/spool/spool.h"

namespace binderjet {
namespace {

void forget_held_jobs(const std::string& folder) {
  const Spool journals(emulator_journals(folder));
  const Result<File> lock = journals.lock();
  if (!lock) return;  // nothing was ever sent here
  for (const JobStatus& job : value_or_throw(journals.jobs())) {
    if (job.state == JobState::kHeld) value_or_throw(journals.remove(journals.held(job.id)));
  }
}

EmulatorOptions watched(EmulatorOptions options, PrintWatcher& watcher) {
  options.watcher = &watcher;
  options.keep_layers = false;
  return options;
}

}  // namespace

FolderPrinter::FolderPrinter(const std::string& folder, EmulatorOptions options,
                             MeasuredPrints::Say say)
    : socket_(value_or_throw(PrinterSocket::listen(folder))),
      prints_(folder, std::move(say)),
      printer_(watched(std::move(options), prints_)) {
  forget_held_jobs(folder);
}

void FolderPrinter::serve(const std::function<bool()>& stop) {
  serve_on_socket(printer_, socket_, stop);
}

PlayedPrinter::PlayedPrinter(const std::string& folder)
    : printer_(folder, {},
               [this](MeasuredPrints::News, const PrintedJob& job) {
                 const std::lock_guard lock(mutex_);
                 why_not_ = job.why_not;
               }),
      thread_([this] {
        try {
          printer_.serve([this] { return stopped_.load(); });
        } catch (...) {
          failure_ = std::current_exception();
        }
      }) {}

PlayedPrinter::~PlayedPrinter() {
  stopped_ = true;
  if (thread_.joinable()) thread_.join();
}

void PlayedPrinter::stop() {
  stopped_ = true;
  thread_.join();
  if (failure_) std::rethrow_exception(failure_);
}

std::string PlayedPrinter::why_not() {
  const std::lock_guard lock(mutex_);
  return why_not_;
}

std::unique_ptr<PlayedPrinter> play_printer(const std::string& uri) {
  const auto folder = emulator_folder(uri);
  if (!folder || connect_to_printer(*folder)) return nullptr;
  return std::make_unique<PlayedPrinter>(*folder);
}

}  // namespace binderjet
