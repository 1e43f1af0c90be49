// SPDX-License-Identifier: GPL-3.0-or-later
// The foot of a terminal, where long work is seen: what is done, how far it is, its rate and the
// time left. One line, painted over and over, and gone before anything else is said.
//
//   scoring [###########                   ] 340/912 layers, 35/s, 0:16 left
//   repairing, 0:12                          nobody knows how long; so long so far
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "slicer/base/work.h"

namespace binderjet {

// How far a stage is after so many seconds.
struct Progress {
  std::string what;  // with the stages around it: "reading models: repairing"
  std::string unit;
  std::int64_t done = 0;
  std::int64_t total = 0;   // 0: unknown
  std::int64_t before = 0;  // done before the clock ran
  double seconds = 0;
};

// At most `columns` - 1 characters: first the bar goes, then the end.
std::string text_of(const Progress& progress, int columns);

class ProgressLine : public WorkListener {
 public:
  ProgressLine() = default;
  ~ProgressLine() override;
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  // Stages that begin from now on are painted if `paints`, notes are printed if `talks`.
  void configure(bool paints, bool talks);
  // Prints a line on stderr in the place of what is painted.
  void say(const std::string& text);
  // Takes what is painted off the terminal; for output that goes elsewhere.
  void clear();

  // Throws Error{kInterrupted} after Ctrl-C, so that all work that advances ends cleanly.
  void check() override;
  void begun(const Stage& stage) override;
  void advanced(const Stage& stage) override;
  void ended(const Stage& stage) noexcept override;
  void note(const std::string& text) override;

 private:
  using Clock = std::chrono::steady_clock;
  struct Begun {
    const Stage* stage;
    Clock::time_point at;
  };

  // These want the mutex.
  void paint();
  void erase();
  // Paints a few times a second whatever the work does meanwhile.
  void tick();

  std::mutex mutex_;
  std::condition_variable over_;
  std::vector<Begun> stages_;  // each within the one before it
  Clock::time_point first_{};  // when the first of all began
  std::atomic<bool> paints_ = false;
  bool talks_ = false;
  bool painted_ = false;  // something stands on the terminal
  bool ends_ = false;
  // BINDERJET_PROGRESS_AFTER; with 0 each step is painted as it is done.
  std::chrono::duration<double> after_{};
  std::thread ticker_;
};

}  // namespace binderjet
