// SPDX-License-Identifier: GPL-3.0-or-later
// Sessions. A new session begins in whatever bytes an old one left in the pipes; its WELCOME is
// found among them by the session's number. The first frame that is not as it should be ends it.
#include "transport/printer/printer_session.h"

#include <fmt/core.h>
#include <sys/random.h>

#include <algorithm>
#include <utility>

namespace binderjet {
namespace {

using protocol::Frame;
using protocol::Type;

// The longest answer: STATUS with 255 supplies.
constexpr std::size_t kMaxAnswerBytes = 160 << 10;
constexpr std::size_t kMaxNoiseBytes = 1 << 20;
constexpr auto kCheckTime = std::chrono::milliseconds(100);
constexpr auto kAskTime = std::chrono::seconds(2);
constexpr auto kStaleTime = std::chrono::milliseconds(500);

std::uint64_t random_number() {
  std::uint64_t value = 0;
  if (getrandom(&value, sizeof value, 0) != sizeof value) {
    value = static_cast<std::uint64_t>(PrinterSession::Clock::now().time_since_epoch().count());
  }
  return value;
}

double seconds_of(std::chrono::milliseconds time) {
  return std::chrono::duration<double>(time).count();
}

}  // namespace

PrinterSession::PrinterSession(std::unique_ptr<PrinterLink> link,
                               std::chrono::milliseconds patience, Check check)
    : link_(std::move(link)),
      patience_(patience),
      check_(std::move(check)),
      decoder_(kMaxAnswerBytes) {}

tl::unexpected<Failure> PrinterSession::broken(const std::string& what) {
  healable_ = true;
  return tl::unexpected(Failure{FailureKind::kDevice, printer_uri(), what});
}

tl::unexpected<Failure> PrinterSession::link_failure() {
  if (!gone()) return broken(link_->trouble());
  healable_ = false;
  return tl::unexpected(Failure{FailureKind::kDevice, printer_uri(), link_->trouble()});
}

Result<protocol::Welcome> PrinterSession::greet(Clock::time_point until) {
  healable_ = false;
  decoder_.reset();
  pending_.clear();
  pending_at_ = 0;
  next_out_ = 0;
  next_in_ = 1;  // the welcome is 0
  if (!link_->restart()) {
    if (gone()) return link_failure();
    return broken("the printer does not answer a reset; switch it off and on");
  }
  protocol::Hello hello;
  hello.session = random_number();
  post(Type::kHello, protocol::encode(hello));
  std::vector<std::byte> heard;
  std::size_t looked = 0;
  bool refused_version = false;
  while (Clock::now() < until) {
    if (auto wanted = check_(); !wanted) return tl::unexpected(wanted.error());
    link_->wait(std::min(until, Clock::now() + kCheckTime));
    const std::vector<std::byte> more = link_->take_input();
    if (more.empty() && link_->state() != LinkState::kFine) return link_failure();
    heard.insert(heard.end(), more.begin(), more.end());
    if (heard.size() > kMaxNoiseBytes) return broken("the printer sends bytes that are no answer");
    if (const auto refused = protocol::find_frame(heard, Type::kRefused, 4096)) {
      const auto why = protocol::decode_refused(refused->frame.payload);
      // Left over from an earlier session it is followed by the welcome.
      if (why && why->reason == protocol::Refusal::kNoVersion && !refused_version) {
        refused_version = true;
        until = std::min(until, Clock::now() + kStaleTime);
      }
    }
    for (std::size_t at = looked;;) {
      const auto found = protocol::find_frame(heard, Type::kWelcome, kMaxAnswerBytes, at);
      if (!found) break;
      at = found->end;
      const auto welcome = protocol::decode_welcome(found->frame.payload);
      if (!welcome || welcome->session != hello.session || found->frame.sequence != 0) continue;
      if (welcome->version != protocol::kVersion) {
        return tl::unexpected(Failure{FailureKind::kDevice, printer_uri(),
                                      fmt::format("speaks version {} of binderjet-1 where {} was "
                                                  "asked for; update its firmware",
                                                  welcome->version, protocol::kVersion)});
      }
      pending_.assign(heard.begin() + static_cast<std::ptrdiff_t>(found->end), heard.end());
      last_sent_ = link_->sent();
      last_sign_ = last_heard_ = asked_ = Clock::now();
      return *welcome;
    }
    // A frame may be half there, but none is longer than this.
    looked = heard.size() > kMaxAnswerBytes + 64 ? heard.size() - kMaxAnswerBytes - 64 : 0;
  }
  if (refused_version) {
    return tl::unexpected(
        Failure{FailureKind::kDevice, printer_uri(),
                "speaks no version of binderjet-1 that this program knows; update one of them"});
  }
  return broken("the printer does not answer; is it a binderjet-1 printer?");
}

void PrinterSession::post(Type type, std::span<const std::byte> payload,
                          std::span<const std::byte> more) {
  link_->post(protocol::encode_frame(type, next_out_++, payload, more));
}

Result<void> PrinterSession::check_patience() {
  const auto now = Clock::now();
  if (const std::uint64_t sent = link_->sent(); sent != last_sent_) {
    last_sent_ = sent;
    last_sign_ = now;
  }
  const bool busy = link_->unsent() > 0;
  // Taking data for long without a word is as good as a word; but silence while nothing is on its
  // way counts from the last word.
  const auto since = busy ? std::max(last_sign_, last_heard_) : last_heard_;
  if (now - since > patience_) {
    return broken(fmt::format("the printer {} for {:.3g} s",
                              busy ? "takes no data" : "says nothing", seconds_of(patience_)));
  }
  const auto ask_after = std::min<Clock::duration>(kAskTime, patience_ / 4);
  if (!busy && now - last_heard_ > ask_after && now - asked_ > ask_after) {
    asked_ = now;
    post(Type::kAskStatus, {});
  }
  return {};
}

Result<std::optional<Frame>> PrinterSession::next(Clock::time_point until) {
  while (true) {
    while (pending_at_ < pending_.size()) {
      pending_at_ += decoder_.feed(std::span(pending_).subspan(pending_at_));
      if (!decoder_.fault().empty()) return broken("the printer sends " + decoder_.fault());
      if (std::optional<Frame> frame = decoder_.take_frame()) {
        if (frame->sequence != next_in_) {
          return broken(fmt::format("answer {} of the printer came where {} was due",
                                    frame->sequence, next_in_));
        }
        ++next_in_;
        last_heard_ = Clock::now();
        return frame;
      }
    }
    pending_at_ = 0;
    pending_ = link_->take_input();
    if (!pending_.empty()) continue;
    if (link_->state() != LinkState::kFine) return link_failure();
    if (auto wanted = check_(); !wanted) return tl::unexpected(wanted.error());
    if (auto patient = check_patience(); !patient) return tl::unexpected(patient.error());
    const auto now = Clock::now();
    if (now >= until) return std::optional<Frame>();
    link_->wait(std::min(until, now + kCheckTime));
  }
}

}  // namespace binderjet
