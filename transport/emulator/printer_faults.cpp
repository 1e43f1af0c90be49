// SPDX-License-Identifier: GPL-3.0-or-later
// The emulated printer's pipes: where the faults of the plan happen, and where layers get printed.
#include <algorithm>
#include <utility>

#include "transport/base/bytes.h"
#include "transport/emulator/printer_emulator.h"

namespace binderjet {

using F = PrinterFault;
using protocol::Type;

namespace {

// Far enough into a frame that it is a layer's, and not far enough that it is whole.
constexpr std::size_t kMidFrame = 60;

}  // namespace

UsbTaken PrinterEmulator::bulk_out(std::span<const std::byte> data) {
  const std::lock_guard lock(mutex_);
  if (gone_) return {UsbOutcome::kGone, 0};
  if (halted_out_) return {UsbOutcome::kStall, 0};
  print_layers();
  if (gone_) return {UsbOutcome::kGone, 0};
  if (Clock::now() < nak_until_) return {UsbOutcome::kNak, 0};
  const UsbTaken taken = take_bytes(data);
  bytes_taken_ += taken.bytes;
  if (options_.on_bytes) options_.on_bytes(data.first(taken.bytes));
  print_layers();
  return taken;
}

// A fault of the data pipe, `taken` bytes into the data.
std::optional<UsbTaken> PrinterEmulator::data_fault(std::span<const std::byte> data,
                                                    std::size_t taken) {
  const int layer = next_layer();
  int ms = 0;
  if (fire(F::kNak, layer, &ms)) {
    nak_until_ = after(ms);
    return UsbTaken{UsbOutcome::kNak, taken};
  }
  if (fire(F::kStall, layer)) {
    halted_out_ = true;
    return UsbTaken{UsbOutcome::kStall, taken};
  }
  if (fire(F::kShortWrite, layer)) return UsbTaken{UsbOutcome::kOk, taken};
  if (fire(F::kSwallow, layer)) return UsbTaken{UsbOutcome::kOk, data.size()};
  if (fire(F::kFlipBit, layer)) {
    flip_next_ = true;
    return std::nullopt;
  }
  if (fire(F::kReset, layer)) {
    end_session();
    return UsbTaken{UsbOutcome::kOk, data.size()};
  }
  if (fire(F::kForgetsJob, layer)) {
    EmulatedJob& job = jobs_.back();
    const std::size_t left = job.layers.size() > 3 ? job.layers.size() - 3 : 0;
    job.layers.resize(left);
    job.digests.resize(left + 1);
    record_[job.number].resize(left);
    end_session();
    return UsbTaken{UsbOutcome::kOk, data.size()};
  }
  if (fire(F::kGone, layer)) {
    lose_power(true);
    return UsbTaken{UsbOutcome::kGone, taken};
  }
  if (fire(F::kPowerLoss, layer)) {
    lose_power(false);
    return UsbTaken{UsbOutcome::kGone, taken};
  }
  return std::nullopt;
}

UsbTaken PrinterEmulator::take_bytes(std::span<const std::byte> data) {
  std::size_t taken = 0;
  while (taken < data.size()) {
    if (deaf_) return {UsbOutcome::kOk, data.size()};
    std::size_t most = data.size() - taken;
    const bool waits = std::any_of(plan_.begin(), plan_.end(), [this](const PlannedFault& fault) {
      return fault.times != 0 && fault.layer == next_layer();
    });
    if (session_ && waits) {
      if (frame_bytes_ >= kMidFrame) {
        if (!faulty_frame_) {
          faulty_frame_ = true;
          if (const auto fault = data_fault(data, taken)) return *fault;
        }
      } else {
        most = std::min(most, kMidFrame - frame_bytes_);
      }
    }
    if (flip_next_) most = 1;
    const std::byte flipped = data[taken] ^ std::byte{0x10};
    const std::size_t fed = decoder_.feed(
        std::exchange(flip_next_, false) ? std::span(&flipped, 1) : data.subspan(taken, most));
    taken += fed;
    frame_bytes_ += fed;
    if (!decoder_.fault().empty()) {
      refuse({}, protocol::Refusal::kDamaged, decoder_.fault());
      deaf_ = true;
    } else if (const auto frame = decoder_.take_frame()) {
      frame_bytes_ = 0;
      faulty_frame_ = false;
      take_frame(*frame);
      print_layers();
      if (gone_) return {UsbOutcome::kGone, taken};
    }
  }
  return {UsbOutcome::kOk, taken};
}

UsbReply PrinterEmulator::bulk_in(std::size_t most) {
  const std::lock_guard lock(mutex_);
  if (gone_) return {UsbOutcome::kGone, {}};
  if (halted_in_) return {UsbOutcome::kStall, {}};
  print_layers();
  if (gone_) return {UsbOutcome::kGone, {}};
  if (halted_in_) return {UsbOutcome::kStall, {}};
  if (Clock::now() < silent_until_) return {UsbOutcome::kNak, {}};
  if (empty_answers_ > 0) {
    --empty_answers_;
    return {UsbOutcome::kOk, {}};
  }
  if (answers_.empty()) return {UsbOutcome::kNak, {}};
  const std::size_t count = byte_by_byte_ ? 1 : std::min(most, answers_.size());
  const auto end = answers_.begin() + static_cast<std::ptrdiff_t>(count);
  UsbReply reply{UsbOutcome::kOk, {answers_.begin(), end}};
  answers_.erase(answers_.begin(), end);
  return reply;
}

bool PrinterEmulator::may_print(int layer) {
  const auto now = Clock::now();
  if (stopped_ == "paused" && now >= paused_until_) {
    stopped_.clear();
    say_status();
  }
  if (!stopped_.empty()) return false;
  int ms = 0;
  const std::pair<F, const char*> reasons[] = {{F::kOutOfPowder, "media-empty"},
                                               {F::kOutOfBinder, "marker-supply-empty"},
                                               {F::kCoverOpen, "cover-open"},
                                               {F::kPaused, "paused"}};
  for (const auto& [fault, reason] : reasons) {
    if (!fire(fault, layer, &ms)) continue;
    stopped_ = reason;
    paused_until_ = after(ms);
    say_status();
    return false;
  }
  if (fire(F::kSlow, layer, &ms)) layer_time_ = std::chrono::milliseconds(ms);
  if (!layer_began_) layer_began_ = now;
  return now >= *layer_began_ + layer_time_;
}

void PrinterEmulator::print_layers() {
  const auto now = Clock::now();
  if (ack_is_late_ && now >= late_until_) {
    ack_is_late_ = false;
    say_progress(Type::kAck);
  }
  if (credit_withheld_ && now >= no_credit_until_) {
    credit_withheld_ = false;
    say_progress(Type::kAck);
  }
  while (!gone_ && open_ && !waiting_.empty()) {
    if (!may_print(static_cast<int>(jobs_.back().layers.size()))) return;
    layer_began_.reset();
    store_layer();
    printed_.notify_all();
    say_ack();
  }
}

// The acknowledgement of the layer that was just printed, or what the plan makes of it.
void PrinterEmulator::say_ack() {
  const EmulatedJob& job = jobs_.back();
  const int layer = static_cast<int>(job.layers.size()) - 1;
  protocol::Progress wrong{job.number, static_cast<std::uint32_t>(layer + 1),
                           static_cast<std::uint32_t>(layer + 2), job.digests.back()};
  int ms = 0;
  if (fire(F::kStallIn, layer)) halted_in_ = true;
  if (fire(F::kLoseAck, layer)) return;
  if (fire(F::kLateAck, layer, &ms)) {
    ack_is_late_ = true;
    late_until_ = after(ms);
  }
  if (ack_is_late_) return;
  if (fire(F::kGoneBeforeAck, layer)) return lose_power(true);
  if (fire(F::kAckTooFar, layer)) {
    wrong.acknowledged += 100;
    wrong.limit += 100;
    return say(Type::kAck, protocol::encode(wrong));
  }
  if (fire(F::kAckOtherJob, layer)) {
    wrong.job ^= 0x55;
    return say(Type::kAck, protocol::encode(wrong));
  }
  if (fire(F::kAckWrongDigest, layer)) {
    wrong.digest ^= 1;
    return say(Type::kAck, protocol::encode(wrong));
  }
  if (fire(F::kNoise, layer)) {
    for (int i = 0; i < 300; ++i) answers_.push_back(static_cast<std::byte>(i * 37));
  }
  if (fire(F::kLyingLength, layer)) {
    std::vector<std::byte> head;
    put_le<std::uint32_t>(head, 0x31554a42);
    put_le<std::uint32_t>(head, static_cast<std::uint8_t>(Type::kAck));
    put_le(head, next_out_);
    put_le<std::uint32_t>(head, 0xffffffff);
    put_le<std::uint64_t>(head, 0);
    put_le(head, checksum(head));
    return say_raw(head);
  }
  if (fire(F::kShortLength, layer)) {
    say_progress(Type::kAck);
    return say_raw(std::vector<std::byte>(7, std::byte{0x42}));
  }
  if (fire(F::kUnknownType, layer)) say(static_cast<Type>(0xee), {});
  if (fire(F::kSkipSequence, layer)) ++next_out_;
  if (fire(F::kByteByByte, layer)) byte_by_byte_ = true;
  if (fire(F::kEmptyAnswers, layer)) empty_answers_ = 200;
  if (fire(F::kSilent, layer, &ms)) silent_until_ = after(ms);
  if (fire(F::kNoCredit, layer, &ms)) {
    credit_withheld_ = true;
    no_credit_until_ = after(ms);
  }
  say_progress(Type::kAck);
  if (fire(F::kRepeatAck, layer)) say_progress(Type::kAck);
  if (fire(F::kWrongStatus, layer)) {
    say(Type::kStatus,
        protocol::encode(protocol::Status{protocol::State::kIdle, job.number, 0, {}, {}}));
  }
  if (fire(F::kStrangeStatus, layer)) {
    say(Type::kStatus,
        protocol::encode(protocol::Status{protocol::State::kProcessing,
                                          job.number,
                                          static_cast<std::uint32_t>(job.layers.size()),
                                          {"moon-too-full", "other-warning", std::string(400, 'x')},
                                          {{"\x1b[31mpowder", 100}, {"", -1}}}));
  }
}

}  // namespace binderjet
