// SPDX-License-Identifier: GPL-3.0-or-later
// A claimed printer as two streams of bytes: several transfers in flight, one thread for events,
// and no wait without an end.
#pragma once

#include <libusb.h>

#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "transport/printer/printer_link.h"
#include "transport/usb/usb_device.h"

namespace binderjet {

class UsbLink : public PrinterLink {
 public:
  UsbLink(UsbContext context, OpenPrinter printer);
  // Cancels and reaps what is in flight.
  ~UsbLink() override;
  UsbLink(const UsbLink&) = delete;
  UsbLink& operator=(const UsbLink&) = delete;

  const std::string& uri() const override { return printer_.uri; }
  void post(std::vector<std::byte> bytes) override;
  std::size_t unsent() const override;
  std::uint64_t sent() const override;
  std::vector<std::byte> take_input() override;
  LinkState state() const override;
  std::string trouble() const override;
  void wait(Clock::time_point until) override;
  // Clears both pipes and says SOFT_RESET.
  bool restart() override;

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
