// SPDX-License-Identifier: GPL-3.0-or-later
#include "driver/base/interrupt.h"

#include <atomic>
#include <csignal>

#include "slicer/base/error.h"

namespace binderjet {
namespace {

std::atomic<int> caught_signal{0};
static_assert(std::atomic<int>::is_always_lock_free, "a signal handler writes it");

void on_signal(int signal) {
  caught_signal = signal;
  // A person's second one ends the program at once. A terminal that closes often sends two SIGHUP.
  std::signal(SIGINT, SIG_DFL);
  std::signal(SIGTERM, SIG_DFL);
}

}  // namespace

void catch_interrupts() {
  struct sigaction action = {};
  action.sa_handler = on_signal;
  sigemptyset(&action.sa_mask);
  // Not SA_RESTART: a call that waits, for a lock, a device or another program, fails and is heard
  // of.
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    struct sigaction before = {};
    sigaction(signal, nullptr, &before);
    // nohup has told this one to be ignored.
    if (signal == SIGHUP && before.sa_handler == SIG_IGN) continue;
    sigaction(signal, &action, nullptr);
  }
  // A file as large as ulimit -f allows is then an error of writing like a full disk.
  std::signal(SIGXFSZ, SIG_IGN);
}

bool interrupted() { return caught_signal != 0; }

void check_interrupt() {
  if (interrupted()) {
    throw Error(ErrorKind::kInterrupted, "", "interrupted; nothing was left half-written");
  }
}

}  // namespace binderjet
