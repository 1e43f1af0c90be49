// SPDX-License-Identifier: GPL-3.0-or-later
// One session of binderjet-1 over a link: greeting, numbered messages out and in, and the patience
// that ends every wait.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "transport/base/result.h"
#include "transport/printer/frame.h"
#include "transport/printer/printer_link.h"
#include "transport/printer/protocol.h"

namespace binderjet {

class PrinterSession {
 public:
  using Clock = std::chrono::steady_clock;
  // Asked every now and then during a wait; a Failure ends it.
  using Check = std::function<Result<void>()>;

  PrinterSession(std::unique_ptr<PrinterLink> link, std::chrono::milliseconds patience,
                 Check check);

  // Begins a session, whatever an earlier one left in either side. On a fault see worth_retrying.
  Result<protocol::Welcome> greet(Clock::time_point until);
  // The fault was one that a new greeting may heal: broken pipe, damaged or senseless message.
  bool worth_retrying() const { return healable_; }
  bool gone() const { return link_->state() == LinkState::kGone; }

  const std::string& printer_uri() const { return link_->uri(); }

  // Sends a message; `more` follows the payload. Never waits.
  void post(protocol::Type type, std::span<const std::byte> payload,
            std::span<const std::byte> more = {});
  // The next message, or nothing at `until`. A printer that neither takes nor says anything for
  // longer than the patience is a Failure.
  Result<std::optional<protocol::Frame>> next(Clock::time_point until);

 private:
  tl::unexpected<Failure> broken(const std::string& what);
  tl::unexpected<Failure> link_failure();
  Result<void> check_patience();

  std::unique_ptr<PrinterLink> link_;
  std::chrono::milliseconds patience_;
  Check check_;
  protocol::FrameDecoder decoder_;
  std::vector<std::byte> pending_;  // came in, not yet decoded
  std::size_t pending_at_ = 0;
  std::uint32_t next_out_ = 0;
  std::uint32_t next_in_ = 0;
  bool healable_ = false;
  std::uint64_t last_sent_ = 0;
  Clock::time_point last_sign_;  // of life: bytes taken or said
  Clock::time_point last_heard_;
  Clock::time_point asked_;  // when the status was last asked for
};

}  // namespace binderjet
