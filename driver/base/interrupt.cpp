// SPDX-License-Identifier: GPL-3.0-or-later
#include "driver/base/interrupt.h"

#include <pthread.h>
#include <semaphore.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <csignal>
#include <mutex>
#include <system_error>
#include <thread>

#include "driver/base/said.h"
#include "slicer/base/error.h"
#include "slicer/base/whole_file.h"

namespace binderjet {
namespace {

std::atomic<int> caught_signal{0};
static_assert(std::atomic<int>::is_always_lock_free, "a signal handler writes it");
sem_t caught;

void on_signal(int signal) {
  caught_signal = signal;
  // A person's second one ends the program at once. A terminal that closes often sends two SIGHUP.
  std::signal(SIGINT, SIG_DFL);
  std::signal(SIGTERM, SIG_DFL);
  sem_post(&caught);
}

// Held by who ends the program, for ever. Never destroyed, for the thread outlives main().
std::timed_mutex& end_of_program() {
  static std::timed_mutex& end = *new std::timed_mutex;
  return end;
}

void watch() {
  while (sem_wait(&caught) != 0) continue;
  constexpr auto kMoment = std::chrono::milliseconds(300);
  constexpr auto kPatience = std::chrono::milliseconds(1400);
  std::this_thread::sleep_for(kMoment);
  say_aside("stopping; once more ends at once");
  std::this_thread::sleep_for(kPatience - kMoment);
  // Who claimed the end and does not come to it waits for somebody who no longer reads.
  static_cast<void>(end_of_program().try_lock_for(kMoment));
  remove_unfinished();
  say_aside(
      "binderjet: interrupted; nothing was left half-written, and a slice goes on where it was");
  _exit(static_cast<int>(ErrorKind::kInterrupted));
}

// Signals go to the threads that work and wait, whose calls they end.
void watch_in_a_thread() {
  sigset_t all;
  sigset_t before;
  sigfillset(&all);
  pthread_sigmask(SIG_SETMASK, &all, &before);
  try {
    std::thread(watch).detach();
  } catch (const std::system_error&) {
    // Where no thread can be had the program ends as soon as its work hears the signal.
  }
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
}

}  // namespace

void catch_interrupts() {
  sem_init(&caught, 0, 0);
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
  watch_in_a_thread();
}

bool interrupted() { return caught_signal != 0; }

void check_interrupt() {
  if (interrupted()) {
    throw Error(ErrorKind::kInterrupted, "", "interrupted; nothing was left half-written");
  }
}

void claim_end() { end_of_program().lock(); }

}  // namespace binderjet
