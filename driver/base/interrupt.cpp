// SPDX-License-Identifier: GPL-3.0-or-later
#include "driver/base/interrupt.h"

#include <atomic>
#include <csignal>

#include "slicer/base/error.h"

namespace binderjet {
namespace {

std::atomic<int> caught_signal{0};
static_assert(std::atomic<int>::is_always_lock_free, "a signal handler writes it");

void on_signal(int signal) { caught_signal = signal; }

}  // namespace

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
