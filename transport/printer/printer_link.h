// SPDX-License-Identifier: GPL-3.0-or-later
// The way to a printer that speaks binderjet-1, whatever it is made of: two streams of bytes, and
// what became of them.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace binderjet {

// What became of the streams.
enum class LinkState {
  kFine,
  kBroken,  // bytes may be lost: restart() and begin a new session
  kGone,    // the printer left; nothing helps but opening it again
};

// Destroyed, it gives the printer free for others.
class PrinterLink {
 public:
  using Clock = std::chrono::steady_clock;

  virtual ~PrinterLink() = default;

  // Which printer this is, as a person names it again.
  virtual const std::string& uri() const = 0;

  // Queues bytes for the printer; never waits.
  virtual void post(std::vector<std::byte> bytes) = 0;
  // Bytes posted and not yet taken by the printer.
  virtual std::size_t unsent() const = 0;
  // Bytes taken so far; grows as long as the printer takes any.
  virtual std::uint64_t sent() const = 0;

  // What came in since the last call.
  virtual std::vector<std::byte> take_input() = 0;
  virtual LinkState state() const = 0;
  // In words, where the state is not fine.
  virtual std::string trouble() const = 0;

  // Waits until there is input, or the state is not fine, or `until`.
  virtual void wait(Clock::time_point until) = 0;

  // Forgets everything posted and everything that came, clears both streams and resets the
  // printer's: ready for a new session. False if the printer is gone or does not answer.
  virtual bool restart() = 0;
};

}  // namespace binderjet
