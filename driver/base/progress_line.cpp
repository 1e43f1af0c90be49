// SPDX-License-Identifier: GPL-3.0-or-later
#include "driver/base/progress_line.h"

#include <fmt/core.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "driver/base/interrupt.h"
#include "driver/base/said.h"
#include "slicer/base/byte_text.h"

namespace binderjet {
namespace {

std::string clock_text(double seconds) {
  const long whole = std::lround(std::min(seconds, 1e6));
  const long hours = whole / 3600;
  const long minutes = whole / 60 % 60;
  return hours > 0 ? fmt::format("{}:{:02}:{:02}", hours, minutes, whole % 60)
                   : fmt::format("{}:{:02}", minutes, whole % 60);
}

// Three digits tell enough: 1240, 35, 3.5, 0.35.
std::string rate_text(double rate) {
  return fmt::format("{:.{}f}/s", rate, rate >= 10 ? 0 : rate >= 1 ? 1 : 2);
}

std::string bar(const Progress& progress) {
  constexpr int kBar = 30;
  const auto full =
      static_cast<int>(std::clamp<std::int64_t>(kBar * progress.done / progress.total, 0, kBar));
  return fmt::format(" [{:#<{}}{: <{}}]", "", full, "", kBar - full);
}

int columns_of_terminal() {
  constexpr int kUsual = 80;
  winsize size{};
  if (ioctl(STDERR_FILENO, TIOCGWINSZ, &size) != 0 || size.ws_col == 0) return kUsual;
  return size.ws_col;
}

double seconds_until_shown() {
  constexpr double kUsual = 0.5;
  const char* given = std::getenv("BINDERJET_PROGRESS_AFTER");
  return given == nullptr ? kUsual : std::strtod(given, nullptr);
}

}  // namespace

std::string text_of(const Progress& progress, int columns) {
  std::string figures;
  const bool known = progress.total > 0;
  const std::int64_t done = progress.done - progress.before;
  if (known || done > 0) {
    figures = fmt::format(" {}{} {}", progress.done,
                          known ? fmt::format("/{}", progress.total) : "", progress.unit);
  }
  if (done > 0 && progress.seconds > 0) {
    const double rate = static_cast<double>(done) / progress.seconds;
    figures += ", " + rate_text(rate);
    if (known) {
      const auto left = static_cast<double>(progress.total - progress.done);
      figures += fmt::format(", {} left", clock_text(std::max(0.0, left) / rate));
    }
  }
  if (done <= 0 || !known) figures += ", " + clock_text(progress.seconds);
  const auto room = static_cast<std::size_t>(std::max(1, columns - 1));
  std::string text = progress.what + (known ? bar(progress) : "") + figures;
  if (text.size() > room) text = progress.what + figures;
  if (text.size() > room) text.resize(room);
  return text;
}

ProgressLine::~ProgressLine() {
  {
    const std::lock_guard lock(mutex_);
    ends_ = true;
  }
  over_.notify_all();
  if (ticker_.joinable()) ticker_.join();
}

void ProgressLine::configure(bool paints, bool talks) {
  const std::lock_guard lock(mutex_);
  paints_ = paints;
  talks_ = talks;
}

void ProgressLine::say(const std::string& text) {
  const std::lock_guard lock(mutex_);
  erase();
  say_line(text);
}

void ProgressLine::clear() {
  const std::lock_guard lock(mutex_);
  erase();
}

void ProgressLine::check() { check_interrupt(); }

void ProgressLine::begun(const Stage& stage) {
  const std::lock_guard lock(mutex_);
  if (!paints_) return;
  stages_.push_back({&stage, Clock::now()});
  if (!ticker_.joinable()) {
    first_ = stages_.back().at;
    after_ = std::chrono::duration<double>(seconds_until_shown());
    ticker_ = std::thread([this] { tick(); });
  }
  if (after_.count() <= 0) paint();
}

void ProgressLine::advanced(const Stage&) {
  check();
  if (!paints_) return;
  const std::lock_guard lock(mutex_);
  if (after_.count() <= 0) paint();
}

void ProgressLine::ended(const Stage& stage) noexcept {
  const std::lock_guard lock(mutex_);
  std::erase_if(stages_, [&](const Begun& begun) { return begun.stage == &stage; });
  if (stages_.empty()) erase();
}

void ProgressLine::note(const std::string& text) {
  if (talks_) say(text);
}

void ProgressLine::paint() {
  if (stages_.empty()) return;
  const auto& [stage, at] = stages_.back();
  Progress progress;
  for (const Begun& begun : stages_) {
    progress.what += (progress.what.empty() ? "" : ": ") + begun.stage->what();
  }
  progress.unit = stage->unit();
  progress.done = stage->done();
  progress.total = stage->total();
  progress.before = stage->before();
  progress.seconds = std::chrono::duration<double>(Clock::now() - at).count();
  // One write, or what others write could come between.
  const std::string line = "\r\033[K" + visible_line(text_of(progress, columns_of_terminal()));
  std::fwrite(line.data(), 1, line.size(), stderr);
  std::fflush(stderr);
  painted_ = true;
}

void ProgressLine::erase() {
  if (!painted_) return;
  std::fputs("\r\033[K", stderr);
  std::fflush(stderr);
  painted_ = false;
}

void ProgressLine::tick() {
  constexpr auto kPeriod = std::chrono::milliseconds(200);
  std::unique_lock lock(mutex_);
  while (!over_.wait_for(lock, kPeriod, [this] { return ends_; })) {
    if (Clock::now() - first_ >= after_) paint();
  }
}

}  // namespace binderjet
