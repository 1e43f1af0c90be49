// SPDX-License-Identifier: GPL-3.0-or-later
// The printer's side of binderjet-1: sessions, jobs, layers.
#include "transport/emulator/printer_emulator.h"

#include <fmt/core.h>

#include <algorithm>
#include <utility>

namespace binderjet {

using protocol::Frame;
using protocol::Refusal;
using protocol::State;
using protocol::Type;

PrinterEmulator::PrinterEmulator(EmulatorOptions options)
    : options_(std::move(options)),
      plan_(options_.plan),
      decoder_(static_cast<std::size_t>(options_.max_layer_bytes) + 64),
      layer_time_(options_.layer_time) {}

PlannedFault* PrinterEmulator::planned(PrinterFault what, int layer) {
  for (PlannedFault& fault : plan_) {
    if (fault.what == what && fault.layer == layer && fault.times != 0) return &fault;
  }
  return nullptr;
}

bool PrinterEmulator::fire(PrinterFault what, int layer, int* ms) {
  PlannedFault* fault = planned(what, layer);
  if (fault == nullptr) return false;
  if (fault->times > 0) --fault->times;
  if (ms != nullptr) *ms = fault->ms;
  return true;
}

bool PrinterEmulator::fire_now(PrinterFault what) {
  for (PlannedFault& fault : plan_) {
    if (fault.what != what || fault.times == 0) continue;
    if (fault.times > 0) --fault.times;
    return true;
  }
  return false;
}

// A time of 0 has no end.
PrinterEmulator::Clock::time_point PrinterEmulator::after(int ms) const {
  return ms == 0 ? Clock::time_point::max() : Clock::now() + std::chrono::milliseconds(ms);
}

int PrinterEmulator::next_layer() const {
  if (!open_ || jobs_.empty()) return -1;
  return static_cast<int>(jobs_.back().layers.size() + waiting_.size());
}

EmulatedJob* PrinterEmulator::find(std::uint64_t number) {
  const auto found = std::find_if(jobs_.begin(), jobs_.end(), [number](const EmulatedJob& job) {
    return job.number == number;
  });
  return found == jobs_.end() ? nullptr : &*found;
}

// The layer that waits longest is printed; what becomes of it survives everything.
void PrinterEmulator::store_layer() {
  EmulatedJob& job = jobs_.back();
  const std::vector<std::byte> records = std::move(waiting_.front().records);
  waiting_.pop_front();
  if (options_.keep_layers) record_[job.number].push_back(static_cast<int>(job.layers.size()));
  job.digests.push_back(protocol::next_digest(job.digests.back(), records));
  job.layers.push_back(options_.keep_layers ? records : std::vector<std::byte>());
  if (options_.watcher != nullptr) options_.watcher->prints(job, records);
}

void PrinterEmulator::end_session() {
  session_ = false;
  open_ = false;
  deaf_ = false;
  decoder_.reset();
  frame_bytes_ = 0;
  faulty_frame_ = flip_next_ = false;
  waiting_.clear();
  answers_.clear();
  layer_began_.reset();
  ack_is_late_ = false;
  credit_withheld_ = false;
  byte_by_byte_ = false;
  empty_answers_ = 0;
}

void PrinterEmulator::lose_power(bool keep_waiting) {
  // Pulling the cable leaves the printer running: it prints what it has.
  while (keep_waiting && open_ && !waiting_.empty()) store_layer();
  end_session();
  halted_out_ = false;
  halted_in_ = false;
  gone_ = true;
}

void PrinterEmulator::say_raw(std::span<const std::byte> bytes) {
  answers_.insert(answers_.end(), bytes.begin(), bytes.end());
}

void PrinterEmulator::say(Type type, std::span<const std::byte> payload) {
  say_raw(protocol::encode_frame(type, next_out_++, payload));
}

void PrinterEmulator::refuse(const Frame& frame, Refusal why, const std::string& text,
                             std::uint64_t job) {
  say(Type::kRefused, protocol::encode(protocol::Refused{frame.sequence, why, job, text}));
  // Behind these two nothing can be trusted to stand where it should.
  if (why == Refusal::kDamaged || why == Refusal::kOutOfOrder) deaf_ = true;
}

void PrinterEmulator::say_status() {
  protocol::Status status;
  const bool printing = !jobs_.empty() && !jobs_.back().done;
  status.state = printing ? State::kProcessing : State::kIdle;
  if (printing) {
    status.job = jobs_.back().number;
    status.acknowledged = static_cast<std::uint32_t>(jobs_.back().layers.size());
  }
  if (!stopped_.empty()) {
    status.state = State::kStopped;
    status.reasons = {stopped_};
  }
  status.supplies = {{"powder", stopped_ == "media-empty" ? 0 : 80},
                     {"binder", stopped_ == "marker-supply-empty" ? 0 : 60}};
  say(Type::kStatus, protocol::encode(status));
}

void PrinterEmulator::say_progress(Type type) {
  const EmulatedJob& job = jobs_.back();
  const auto acknowledged = static_cast<std::uint32_t>(job.layers.size());
  const auto credits = static_cast<std::uint32_t>(credit_withheld_ ? 0 : options_.credits);
  const auto limit = std::min(acknowledged + credits, static_cast<std::uint32_t>(job.layer_count));
  say(type,
      protocol::encode(protocol::Progress{job.number, acknowledged, limit, job.digests.back()}));
}

void PrinterEmulator::take_frame(const Frame& frame) {
  if (frame.type == Type::kHello) return take_hello(frame);
  if (!session_) return refuse(frame, Refusal::kOutOfOrder, "no session");
  if (frame.sequence != next_in_) {
    return refuse(frame, Refusal::kOutOfOrder,
                  fmt::format("frame {} came where {} was due", frame.sequence, next_in_));
  }
  ++next_in_;
  switch (frame.type) {
    case Type::kJob:
      return take_job(frame);
    case Type::kResume:
      return take_resume(frame);
    case Type::kLayer:
      return take_layer(frame);
    case Type::kEnd:
      return take_end(frame);
    case Type::kCancel:
      return take_cancel(frame);
    case Type::kAskStatus:
      return say_status();
    case Type::kPause:
      stopped_ = "paused";
      paused_until_ = Clock::time_point::max();
      return say_status();
    case Type::kContinue:
      stopped_.clear();
      return say_status();
    default:
      return refuse(frame, Refusal::kOutOfOrder, "a message of no known type");
  }
}

void PrinterEmulator::take_hello(const Frame& frame) {
  const auto hello = protocol::decode_hello(frame.payload);
  if (!hello || frame.sequence != 0) return refuse(frame, Refusal::kDamaged, "a strange greeting");
  end_session();
  next_in_ = 1;
  next_out_ = 0;
  if (fire_now(PrinterFault::kNoHello)) return;
  if (hello->lowest > protocol::kVersion || hello->highest < protocol::kVersion) {
    return refuse(frame, Refusal::kNoVersion, "only version 1 is known");
  }
  session_ = true;
  protocol::Welcome welcome;
  if (fire_now(PrinterFault::kOldVersion)) welcome.version = 0;
  welcome.credits = static_cast<std::uint16_t>(options_.credits);
  welcome.capabilities = 7;
  welcome.session = hello->session;
  welcome.max_layer_bytes = options_.max_layer_bytes;
  welcome.max_header_bytes = 16 << 20;
  if (!jobs_.empty() && !jobs_.back().done) {
    welcome.held_job = jobs_.back().number;
    welcome.held_layers = static_cast<std::uint32_t>(jobs_.back().layers.size());
  }
  welcome.name = "binderjet emulated printer " + options_.serial;
  say(Type::kWelcome, protocol::encode(welcome));
}

void PrinterEmulator::take_job(const Frame& frame) {
  auto job = protocol::decode_job(frame.payload);
  if (!job) return refuse(frame, Refusal::kDamaged, "a strange job");
  if (!jobs_.empty() && !jobs_.back().done && jobs_.back().number != job->job) {
    return refuse(frame, Refusal::kHoldsAnother, "another job is unfinished", jobs_.back().number);
  }
  if (EmulatedJob* known = find(job->job)) {
    if (known->done || known->header != job->header || !known->layers.empty()) {
      return refuse(frame, Refusal::kOtherJob, "this number was given out before");
    }
  } else {
    EmulatedJob fresh;
    fresh.number = job->job;
    fresh.layer_count = static_cast<int>(job->layers);
    fresh.digests = {protocol::first_digest(job->header, job->layers)};
    fresh.header = std::move(job->header);
    jobs_.push_back(std::move(fresh));
    if (options_.watcher != nullptr) options_.watcher->begins(jobs_.back());
  }
  open_ = true;
  say_progress(Type::kReady);
}

void PrinterEmulator::take_resume(const Frame& frame) {
  const auto resume = protocol::decode_resume(frame.payload);
  if (!resume) return refuse(frame, Refusal::kDamaged, "a strange resume");
  const EmulatedJob* job = find(resume->job);
  if (job == nullptr) return refuse(frame, Refusal::kUnknownJob, "never heard of it");
  if (job != &jobs_.back()) return refuse(frame, Refusal::kUnknownJob, "long done");
  if (static_cast<std::uint32_t>(job->layer_count) != resume->layers ||
      (resume->acknowledged < job->digests.size() &&
       job->digests[resume->acknowledged] != resume->digest)) {
    return refuse(frame, Refusal::kOtherJob, "it began otherwise");
  }
  open_ = true;
  say_progress(Type::kReady);
}

void PrinterEmulator::take_layer(const Frame& frame) {
  const auto head = protocol::decode_layer_head(frame.payload);
  if (!head || !open_ || jobs_.back().done || head->job != jobs_.back().number) {
    return refuse(frame, Refusal::kOutOfOrder, "a layer of no open job");
  }
  if (head->layer < jobs_.back().layers.size()) ++sent_again_;
  if (head->layer != static_cast<std::uint32_t>(next_layer())) {
    return refuse(frame, Refusal::kOutOfOrder,
                  fmt::format("layer {} came where {} was due", head->layer, next_layer()));
  }
  if (static_cast<int>(waiting_.size()) >= options_.credits || credit_withheld_) {
    return refuse(frame, Refusal::kOutOfOrder, "a layer beyond the credit");
  }
  waiting_.push_back(
      {head->job, {frame.payload.begin() + protocol::kLayerHeadBytes, frame.payload.end()}});
  max_waiting_ = std::max(max_waiting_, static_cast<int>(waiting_.size()));
}

void PrinterEmulator::take_end(const Frame& frame) {
  const auto totals = protocol::decode_totals(frame.payload);
  EmulatedJob* job = totals ? find(totals->job) : nullptr;
  if (job == nullptr || !open_ || job != &jobs_.back() ||
      static_cast<int>(job->layers.size()) != job->layer_count) {
    return refuse(frame, Refusal::kOutOfOrder, "the end of no whole job");
  }
  if (totals->digest != job->digests.back()) {
    return refuse(frame, Refusal::kOtherJob, "it ends otherwise");
  }
  if (options_.watcher != nullptr && !job->done) options_.watcher->ends(*job);
  job->done = true;
  if (!options_.keep_layers) job->header.clear();
  protocol::Totals done = *totals;
  if (fire_now(PrinterFault::kWrongDone)) done.digest ^= 1;
  if (fire_now(PrinterFault::kLoseDone)) return;
  if (fire_now(PrinterFault::kGoneBeforeDone)) return lose_power(true);
  say(Type::kDone, protocol::encode(done));
}

void PrinterEmulator::take_cancel(const Frame& frame) {
  const auto number = protocol::decode_key(frame.payload);
  if (!number) return refuse(frame, Refusal::kDamaged, "a strange cancel");
  if (find(*number) == nullptr || find(*number)->done) {
    return refuse(frame, Refusal::kUnknownJob, "never heard of it", *number);
  }
  if (options_.watcher != nullptr) options_.watcher->forgets(jobs_.back());
  record_.erase(*number);
  jobs_.pop_back();  // only the last may be unfinished
  open_ = false;
  waiting_.clear();
  say(Type::kCancelled, protocol::encode_key(*number));
}

}  // namespace binderjet
