// SPDX-License-Identifier: GPL-3.0-or-later
// A claimed printer as two streams of bytes: several transfers in flight, one thread for events,
// and no wait without an end.
#pragma once

#include <libusb.h>

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include "transport/usb/usb_device.h"

namespace binderjet {

// What became of the stream.
enum class LinkState {
  kFine,
  kBroken,  // bytes may be lost: restart() and begin a new session
  kGone,    // the device left; nothing helps but opening it again
};

class UsbLink {
 public:
  using Clock = std::chrono::steady_clock;

  UsbLink(UsbContext context, OpenPrinter printer);
  // Cancels and reaps what is in flight.
  ~UsbLink();
  UsbLink(const UsbLink&) = delete;
  UsbLink& operator=(const UsbLink&) = delete;

  const OpenPrinter& printer() const { return printer_; }

  // Queues bytes for the OUT pipe; never waits.
  void post(std::vector<std::byte> bytes);
  // Bytes posted and not yet taken by the device.
  std::size_t unsent() const;
  // Bytes taken so far; grows as long as the device takes any.
  std::uint64_t sent() const;

  // What came in since the last call.
  std::vector<std::byte> take_input();
  LinkState state() const;
  // In words, where the state is not fine.
  std::string trouble() const;

  // Waits until there is input, or the state is not fine, or nothing is unsent (if asked), or
  // `until`.
  void wait(Clock::time_point until, bool for_sent = false);

  // Forgets everything posted and everything that came, clears both pipes and resets the
  // printer's: ready for a new session. False if the device is gone or does not answer.
  bool restart();

 private:
  struct Piece;
  static void LIBUSB_CALL out_done(libusb_transfer* transfer);
  static void LIBUSB_CALL in_done(libusb_transfer* transfer);
  void run_events();
  // All below: with the lock.
  void submit_out();
  void submit_in();
  void take_back();
  void cancel_all();
  void set_state(LinkState state, const std::string& why);
  void reap_all(std::unique_lock<std::mutex>& lock);
  bool soft_reset();

  UsbContext context_;
  OpenPrinter printer_;

  mutable std::mutex mutex_;
  std::condition_variable changed_;
  LinkState state_ = LinkState::kFine;
  std::string trouble_;
  bool stopping_ = false;  // nothing new is submitted

  // OUT: bytes wait in chunks; pieces of the front chunks are in flight, oldest first.
  std::deque<std::shared_ptr<std::vector<std::byte>>> chunks_;
  std::size_t front_taken_ = 0;  // of the front chunk, up to where pieces were submitted
  std::deque<std::unique_ptr<Piece>> flight_;
  bool draining_ = false;  // a piece came back short: no new ones until all are back
  std::size_t piece_bytes_;
  std::size_t depth_;
  bool no_memory_ = false;
  int empty_in_a_row_ = 0;
  Clock::time_point retry_at_{};
  std::size_t unsent_ = 0;
  std::uint64_t sent_ = 0;

  libusb_transfer* in_ = nullptr;
  bool in_flight_ = false;
  std::vector<unsigned char> in_buffer_;
  std::vector<std::byte> input_;

  bool quit_ = false;
  std::thread events_;  // last: it uses all of the above
};

}  // namespace binderjet
