// SPDX-License-Identifier: GPL-3.0-or-later
// Sending, believing acknowledgements, and starting over from the last of them.
#include "transport/printer/printer_job.h"

#include <fmt/core.h>

#include <algorithm>
#include <utility>

namespace binderjet {
namespace {

using protocol::Frame;
using protocol::Progress;
using protocol::Refusal;
using protocol::State;
using protocol::Type;

// Recoveries in a row that bring no new acknowledgement.
constexpr int kMaxFailures = 3;
constexpr int kGreetings = 3;
constexpr auto kGreetTime = std::chrono::seconds(5);

// Someone at the printer pauses it and goes on; everything else that stops it needs a hand, and the
// hand may be far away: that is told at once.
bool only_paused(const std::vector<std::string>& reasons) {
  return std::all_of(reasons.begin(), reasons.end(), [](const std::string& reason) {
    return reason == "paused" || reason == "moving-to-paused" || reason == "none" ||
           reason.ends_with("-report") || reason.ends_with("-warning");
  });
}

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : ", ") + word;
  return text.empty() ? "no reason given" : text;
}

}  // namespace

PrinterJob::PrinterJob(std::unique_ptr<PrinterSession> session, std::chrono::milliseconds patience,
                       Keep keep)
    : session_(std::move(session)), patience_(patience), keep_(std::move(keep)) {}

tl::unexpected<Failure> PrinterJob::broken(const std::string& what) {
  healable_ = true;
  return final(what);
}

tl::unexpected<Failure> PrinterJob::final(const std::string& what) {
  return tl::unexpected(Failure{FailureKind::kDevice, printer_uri(), what});
}

Result<protocol::Welcome> PrinterJob::greet() {
  // A printer that was just switched on may miss the first one.
  const auto time = std::min<Clock::duration>(patience_, kGreetTime) / kGreetings;
  auto welcome = session_->greet(Clock::now() + time);
  for (int i = 1; i < kGreetings && !welcome && session_->worth_retrying(); ++i) {
    welcome = session_->greet(Clock::now() + time);
  }
  if (welcome) {
    max_layer_bytes_ = welcome->max_layer_bytes;
    max_header_bytes_ = welcome->max_header_bytes;
  }
  return welcome;
}

// Waits for one kind of message; others are taken as they come.
Result<Frame> PrinterJob::answer(Type type, Clock::time_point until) {
  while (true) {
    Result<std::optional<Frame>> next = session_->next(until);
    if (!next) return tl::unexpected(next.error());
    std::optional<Frame> frame = *std::move(next);
    if (!frame) return broken("the printer does not answer");
    if (frame->type == type) return *std::move(frame);
    if (auto done = take(*frame); !done) return tl::unexpected(done.error());
  }
}

Result<Progress> PrinterJob::open(bool resumed) {
  if (resumed) {
    session_->post(Type::kResume, protocol::encode(protocol::Resume{
                                      number_, static_cast<std::uint32_t>(layers_),
                                      static_cast<std::uint32_t>(acknowledged_), digest_}));
  } else {
    session_->post(Type::kJob, protocol::encode(protocol::Job{
                                   number_, static_cast<std::uint32_t>(layers_), header_}));
  }
  Result<Frame> frame = answer(Type::kReady, Clock::now() + patience_);
  if (!frame) return tl::unexpected(frame.error());
  const auto ready = protocol::decode_progress(frame->payload);
  if (!ready || ready->job != number_ ||
      ready->acknowledged > static_cast<std::uint32_t>(layers_)) {
    return broken("the printer's answer makes no sense");
  }
  return *ready;
}

// RESUME, or JOB where the printer has never heard of the job.
Result<void> PrinterJob::reopen() {
  healable_ = false;
  open_ = false;
  Result<Progress> ready = open(true);
  if (!ready && !healable_ && acknowledged_ == 0 && in_the_way_ == number_) {
    ready = open(false);
  }
  if (!ready) return tl::unexpected(ready.error());
  const int there = static_cast<int>(ready->acknowledged);
  if (there < acknowledged_) {
    return final(
        fmt::format("the printer lost layers that it had acknowledged, from layer {}; "
                    "cancel the job and print it again",
                    there));
  }
  if (there > posted_) {
    return final("the printer acknowledges layers it was not sent; cancel the job");
  }
  posted_ = there;
  return take_progress(*ready);
}

Result<void> PrinterJob::start(std::uint64_t number, int layers, const std::string& header) {
  number_ = number;
  layers_ = layers;
  header_ = header;
  acknowledged_ = 0;
  digest_ = protocol::first_digest(header, static_cast<std::uint32_t>(layers));
  healable_ = false;
  if (header.size() > max_header_bytes_) {
    return final(fmt::format("takes a job's header of {} bytes at most, and this one has {}",
                             max_header_bytes_, header.size()));
  }
  Result<Progress> ready = open(false);
  if (ready) return take_progress(*ready);
  return recover(ready.error());
}

Result<int> PrinterJob::resume(std::uint64_t number, int layers, const std::string& header,
                               int acknowledged, std::uint64_t digest) {
  number_ = number;
  layers_ = layers;
  header_ = header;
  acknowledged_ = acknowledged;
  digest_ = acknowledged == 0 ? protocol::first_digest(header, static_cast<std::uint32_t>(layers))
                              : digest;
  // An earlier process may have sent as many as the printer ever has room for.
  posted_ = std::min(layers, acknowledged + static_cast<int>(protocol::kMaxCredits));
  if (auto done = reopen(); !done) {
    if (auto healed = recover(done.error()); !healed) return tl::unexpected(healed.error());
  }
  return acknowledged_;
}

Result<void> PrinterJob::send(int layer, std::span<const std::byte> records) {
  if (records.size() > max_layer_bytes_) {
    return final(fmt::format("takes layers of {} bytes at most, and this one has {}",
                             max_layer_bytes_, records.size()));
  }
  const std::uint64_t before = window_.empty() ? digest_ : window_.back().digest;
  window_.push_back({{records.begin(), records.end()}, protocol::next_digest(before, records)});
  return run_until([this, layer] { return posted_ > layer; });
}

Result<void> PrinterJob::end() {
  while (true) {
    if (auto done = run_until([this] { return acknowledged_ == layers_; }); !done) return done;
    const int opening = openings_;
    finished_.reset();
    session_->post(Type::kEnd, protocol::encode(protocol::Totals{
                                   number_, static_cast<std::uint32_t>(layers_), digest_}));
    const auto answered = [this, opening] { return finished_ || openings_ != opening; };
    if (auto done = run_until(answered); !done) return done;
    if (finished_) break;
  }
  if (finished_->job != number_ || finished_->digest != digest_ ||
      finished_->layers != static_cast<std::uint32_t>(layers_)) {
    return final("the printer says that it has printed something else than it was sent");
  }
  return {};
}

void PrinterJob::post_layers() {
  const int last = acknowledged_ + static_cast<int>(window_.size());
  while (posted_ < last && posted_ < limit_) {
    const Sent& sent = window_[static_cast<std::size_t>(posted_ - acknowledged_)];
    session_->post(
        Type::kLayer,
        protocol::encode(protocol::LayerHead{number_, static_cast<std::uint32_t>(posted_)}),
        sent.records);
    ++posted_;
  }
}

Result<void> PrinterJob::run_until(const Done& done) {
  while (true) {
    post_layers();
    // What is there already is taken even if nobody has to wait for it: acknowledgements make room.
    const bool over = done();
    const Result<std::optional<Frame>> next =
        session_->next(over ? Clock::now() : Clock::now() + std::chrono::seconds(1));
    const std::optional<Frame> frame = next.value_or(std::nullopt);
    Result<void> taken;
    healable_ = false;
    if (!next) {
      healable_ = session_->worth_retrying();
      taken = tl::unexpected(next.error());
    } else if (frame) {
      taken = take(*frame);
    } else if (over) {
      return {};
    }
    if (!taken) {
      if (auto healed = recover(taken.error()); !healed) return healed;
    }
  }
}

// Goes on from the last acknowledged layer, if the fault is one that a new session may heal.
Result<void> PrinterJob::recover(Failure fault) {
  bool again = healable_ || session_->worth_retrying();
  while (again && !session_->gone() && fault.kind == FailureKind::kDevice) {
    if (++failures_ > kMaxFailures) break;
    ++openings_;
    healable_ = false;
    Result<void> healed;
    if (const auto welcome = greet(); !welcome) {
      healed = tl::unexpected(welcome.error());
    } else {
      healed = reopen();
    }
    if (healed) return {};
    again = healable_ || session_->worth_retrying();
    // What went wrong first says more than how the attempts to heal it failed, unless one of them
    // found a reason that no attempt can heal.
    if (!again) fault = healed.error();
  }
  return tl::unexpected(std::move(fault));
}

Result<void> PrinterJob::take(const Frame& frame) {
  switch (frame.type) {
    case Type::kAck:
      if (const auto progress = protocol::decode_progress(frame.payload);
          progress && progress->job == number_) {
        return take_progress(*progress);
      }
      break;
    case Type::kStatus:
      if (const auto status = protocol::decode_status(frame.payload)) return take_status(*status);
      break;
    case Type::kRefused:
      if (const auto refused = protocol::decode_refused(frame.payload)) {
        return take_refusal(*refused);
      }
      break;
    case Type::kDone:
      finished_ = protocol::decode_totals(frame.payload);
      if (finished_) return {};
      break;
    default:
      break;
  }
  return broken("the printer's message makes no sense");
}

Result<void> PrinterJob::take_progress(const Progress& progress) {
  const int there = static_cast<int>(std::min<std::uint32_t>(progress.acknowledged, 0x7fffffff));
  if (there > posted_) return broken("the printer acknowledges a layer it was not sent");
  if (there > acknowledged_) {
    const auto count = static_cast<std::size_t>(there - acknowledged_);
    // Only a resume finds layers acknowledged that this process never had: there the printer's
    // digest is the only one.
    const std::uint64_t digest =
        count <= window_.size() ? window_[count - 1].digest : progress.digest;
    if (digest != progress.digest) {
      return broken("the printer acknowledges another layer than was sent");
    }
    // First the journal, then the layer may be forgotten.
    if (auto kept = keep_(there, digest); !kept) return kept;
    window_.erase(window_.begin(),
                  window_.begin() + static_cast<std::ptrdiff_t>(std::min(count, window_.size())));
    acknowledged_ = there;
    digest_ = digest;
    failures_ = 0;
  }
  open_ = true;
  const auto most = static_cast<std::uint32_t>(acknowledged_ + protocol::kMaxCredits);
  limit_ = static_cast<int>(std::min({progress.limit, most, static_cast<std::uint32_t>(layers_)}));
  return {};
}

Result<void> PrinterJob::take_status(const protocol::Status& status) {
  if (status.state == State::kStopped && !only_paused(status.reasons)) {
    return final("the printer stopped: " + joined(status.reasons));
  }
  if (!open_) return {};
  // Messages keep their order: had the printer said that a layer or the job is done, it would have
  // been heard before.
  if (status.job != number_) return broken("the printer no longer works on the job");
  if (status.acknowledged != static_cast<std::uint32_t>(acknowledged_)) {
    return broken(fmt::format("the printer has {} layers and has acknowledged {}",
                              status.acknowledged, acknowledged_));
  }
  return {};
}

Result<void> PrinterJob::take_refusal(const protocol::Refused& refused) {
  in_the_way_ = refused.job;
  switch (refused.reason) {
    case Refusal::kDamaged:
    case Refusal::kOutOfOrder:
      return broken("the printer refuses what it was sent: " + refused.text);
    case Refusal::kUnknownJob:
      in_the_way_ = number_;
      return final("the printer knows nothing of this job; cancel it and print it again");
    default:
      return final("the printer refuses the job: " + refused.text);
  }
}

Result<void> PrinterJob::cancel(std::uint64_t number, Clock::time_point until) {
  number_ = number;
  if (const auto welcome = session_->greet(until); !welcome) {
    return tl::unexpected(welcome.error());
  }
  session_->post(Type::kCancel, protocol::encode_key(number));
  const Result<Frame> answered = answer(Type::kCancelled, until);
  if (!answered && in_the_way_ != number) return tl::unexpected(answered.error());
  return {};
}

Result<protocol::Status> PrinterJob::status(Clock::time_point until) {
  session_->post(Type::kAskStatus, {});
  const Result<Frame> frame = answer(Type::kStatus, until);
  if (!frame) return tl::unexpected(frame.error());
  const auto status = protocol::decode_status(frame->payload);
  if (!status) return broken("the printer's message makes no sense");
  return *status;
}

}  // namespace binderjet
