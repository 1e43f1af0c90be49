// SPDX-License-Identifier: GPL-3.0-or-later
#include "driver/base/console.h"

#include <fmt/core.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <atomic>
#include <cmath>
#include <csignal>
#include <nlohmann/json.hpp>
#include <utility>

#include "slicer/base/error.h"

namespace binderjet {
namespace {

std::atomic<int> caught_signal{0};
static_assert(std::atomic<int>::is_always_lock_free, "a signal handler writes it");

void on_signal(int signal) { caught_signal = signal; }

std::string minutes_and_seconds(double seconds) {
  const long whole = std::lround(seconds);
  return fmt::format("{}:{:02}", whole / 60, whole % 60);
}

}  // namespace

void Console::result(const nlohmann::ordered_json& object, const std::string& text) const {
  if (json) {
    fmt::print("{}\n", object.dump());
  } else if (!quiet && !text.empty()) {
    fmt::print("{}\n", text);
  }
}

void Console::warning(const std::string& text) const {
  fmt::print(stderr, "binderjet: warning: {}\n", text);
}

void Console::note(const std::string& text) const {
  if (!quiet) fmt::print(stderr, "{}\n", text);
}

std::shared_ptr<Console> add_console_options(CLI::App& verb) {
  auto console = std::make_shared<Console>();
  verb.add_flag("--json", console->json, "print the result as one JSON object on stdout");
  verb.add_flag("-q,--quiet", console->quiet, "say nothing but warnings and errors");
  return console;
}

Progress::Progress(const Console& console, std::string label, int total)
    : label_(std::move(label)),
      total_(total),
      visible_(!console.quiet && isatty(STDERR_FILENO) != 0),
      start_(Clock::now()),
      last_(start_) {}

Progress::~Progress() {
  if (visible_) fmt::print(stderr, "\r\033[K");
}

void Progress::advance(int done) {
  check_interrupt();
  const Clock::time_point now = Clock::now();
  if (!visible_ || done == 0 || now - last_ < std::chrono::milliseconds(100)) return;
  last_ = now;
  const double seconds = std::chrono::duration<double>(now - start_).count();
  const double rate = done / seconds;
  constexpr int kBar = 30;
  const int full = static_cast<int>(static_cast<long long>(kBar) * done / std::max(1, total_));
  fmt::print(stderr, "\r\033[K{} [{:#<{}}{: <{}}] {}/{} layers, {:.0f}/s, {} left", label_, "",
             full, "", kBar - full, done, total_, rate,
             minutes_and_seconds((total_ - done) / rate));
  std::fflush(stderr);
}

void catch_interrupts() {
  std::signal(SIGINT, on_signal);
  std::signal(SIGTERM, on_signal);
}

bool interrupted() { return caught_signal != 0; }

void check_interrupt() {
  if (interrupted()) {
    throw Error(ErrorKind::kInterrupted, "", "interrupted; nothing was left half-written");
  }
}

}  // namespace binderjet
