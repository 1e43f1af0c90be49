// SPDX-License-Identifier: GPL-3.0-or-later
// The host's side of one job in binderjet-1: the window of layers under way, and the way back to
// the last acknowledged layer when something goes wrong.
//
//   layers     0 ............ acknowledged_ ....... posted_ ....... limit_ ..... layers_
//              safe there     sent, kept here       may be sent    not yet
//
// Each acknowledgement moves acknowledged_ and, with the printer's credits, limit_. Layers stay in
// memory until they are acknowledged: at most kMaxCredits of them, and one that waits for room.
// After a fault a new session begins, the printer says what it has, and the layers behind that are
// sent again.
#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "transport/base/result.h"
#include "transport/printer/printer_session.h"
#include "transport/printer/protocol.h"

namespace binderjet {

class PrinterJob {
 public:
  using Clock = std::chrono::steady_clock;
  // Makes an acknowledgement survive anything before the layer is forgotten here.
  using Keep = std::function<Result<void>(int layers, std::uint64_t digest)>;

  // `session` has not greeted yet.
  PrinterJob(std::unique_ptr<PrinterSession> session, std::chrono::milliseconds patience,
             Keep keep);

  const std::string& printer_uri() const { return session_->printer_uri(); }

  // First of all; tells what the printer is and which job it holds.
  Result<protocol::Welcome> greet();

  // Opens a job that is new to the printer. `number` is its key, never used before.
  Result<void> start(std::uint64_t number, int layers, const std::string& header);
  // Goes on behind `acknowledged` layers with this digest; returns the first layer to send, which
  // is later where the printer acknowledged more than anybody here knows of.
  Result<int> resume(std::uint64_t number, int layers, const std::string& header, int acknowledged,
                     std::uint64_t digest);
  // Returns when the printer lends room for the layer; it is then on its way.
  Result<void> send(int layer, std::span<const std::byte> records);
  // Returns when every layer is acknowledged and the printer has the same digest of them all.
  Result<void> end();

  int acknowledged() const { return acknowledged_; }

  // Makes the printer forget the job. Gives up at `until`.
  Result<void> cancel(std::uint64_t number, Clock::time_point until);
  Result<protocol::Status> status(Clock::time_point until);
  // The job that stood in the way of the last fault, or 0.
  std::uint64_t in_the_way() const { return in_the_way_; }

 private:
  struct Sent {
    std::vector<std::byte> records;
    std::uint64_t digest = 0;  // of all layers up to this one
  };
  using Done = std::function<bool()>;

  Result<void> run_until(const Done& done);
  void post_layers();
  Result<void> take(const protocol::Frame& frame);
  Result<void> take_progress(const protocol::Progress& progress);
  Result<void> take_status(const protocol::Status& status);
  Result<void> take_refusal(const protocol::Refused& refused);
  Result<void> recover(Failure fault);
  Result<void> reopen();
  Result<protocol::Progress> open(bool resumed);
  Result<protocol::Frame> answer(protocol::Type type, Clock::time_point until);
  tl::unexpected<Failure> broken(const std::string& what);
  tl::unexpected<Failure> final(const std::string& what);

  std::unique_ptr<PrinterSession> session_;
  std::chrono::milliseconds patience_;
  Keep keep_;

  std::uint64_t max_layer_bytes_ = 0;  // as WELCOME says
  std::uint64_t max_header_bytes_ = 0;
  std::uint64_t number_ = 0;
  int layers_ = 0;
  std::string header_;
  int acknowledged_ = 0;
  std::uint64_t digest_ = 0;  // of the acknowledged layers
  std::deque<Sent> window_;   // layers acknowledged_ and on
  int posted_ = 0;            // layers below this are on their way, or were
  int limit_ = 0;             // layers below this may be
  bool open_ = false;         // the printer has said READY in this session
  bool healable_ = false;     // the last fault of take()
  int failures_ = 0;          // since the last acknowledgement
  int openings_ = 0;          // counts recoveries: what was asked before one is not answered
  std::optional<protocol::Totals> finished_;
  std::uint64_t in_the_way_ = 0;
};

}  // namespace binderjet
