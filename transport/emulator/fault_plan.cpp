// SPDX-License-Identifier: GPL-3.0-or-later
// The words of the faults.
#include "transport/emulator/fault_plan.h"

#include <fmt/core.h>

#include <charconv>
#include <string_view>
#include <utility>

namespace binderjet {
namespace {

using F = PrinterFault;

constexpr std::pair<F, const char*> kWords[] = {
    {F::kNak, "nak"},
    {F::kStall, "stall"},
    {F::kShortWrite, "short-write"},
    {F::kSwallow, "swallow"},
    {F::kFlipBit, "flip-bit"},
    {F::kReset, "reset"},
    {F::kGone, "gone"},
    {F::kPowerLoss, "power-loss"},
    {F::kStallIn, "stall-in"},
    {F::kLoseAck, "lose-ack"},
    {F::kRepeatAck, "repeat-ack"},
    {F::kLateAck, "late-ack"},
    {F::kGoneBeforeAck, "gone-before-ack"},
    {F::kAckTooFar, "ack-too-far"},
    {F::kAckOtherJob, "ack-other-job"},
    {F::kAckWrongDigest, "ack-wrong-digest"},
    {F::kNoise, "noise"},
    {F::kLyingLength, "lying-length"},
    {F::kShortLength, "short-length"},
    {F::kUnknownType, "unknown-type"},
    {F::kSkipSequence, "skip-sequence"},
    {F::kByteByByte, "byte-by-byte"},
    {F::kEmptyAnswers, "empty-answers"},
    {F::kSilent, "silent"},
    {F::kWrongStatus, "wrong-status"},
    {F::kStrangeStatus, "strange-status"},
    {F::kOutOfPowder, "out-of-powder"},
    {F::kOutOfBinder, "out-of-binder"},
    {F::kCoverOpen, "cover-open"},
    {F::kPaused, "paused"},
    {F::kSlow, "slow"},
    {F::kNoCredit, "no-credit"},
    {F::kNoHello, "no-hello"},
    {F::kOldVersion, "old-version"},
    {F::kWrongDone, "wrong-done"},
    {F::kLoseDone, "lose-done"},
    {F::kGoneBeforeDone, "gone-before-done"},
    {F::kStallDeviceId, "stall-device-id"},
    {F::kSwappedDeviceId, "swapped-device-id"},
    {F::kResetClass10, "reset-class-1.0"},
    {F::kPortStatus, "port-status"},
    {F::kHangControl, "hang-control"},
    {F::kForgetsJob, "forgets-job"},
};

bool take_number(std::string_view& rest, char mark, int& value) {
  if (rest.empty() || rest.front() != mark) return true;
  const auto [end, error] = std::from_chars(rest.data() + 1, rest.data() + rest.size(), value);
  if (error != std::errc()) return false;
  rest.remove_prefix(static_cast<std::size_t>(end - rest.data()));
  return true;
}

}  // namespace

const char* fault_word(PrinterFault fault) {
  for (const auto& [one, word] : kWords) {
    if (one == fault) return word;
  }
  return "?";
}

std::optional<PlannedFault> parse_fault(const std::string& text) {
  const std::size_t at = text.find('@');
  std::string_view rest = std::string_view(text).substr(std::min(at, text.size()));
  const std::string word = text.substr(0, at);
  for (const auto& [one, name] : kWords) {
    if (word != name) continue;
    PlannedFault fault{one};
    if (!take_number(rest, '@', fault.layer) || !take_number(rest, 'x', fault.times) ||
        !take_number(rest, ':', fault.ms) || !rest.empty() || fault.layer < 0 || fault.times < -1 ||
        fault.ms < 0) {
      return std::nullopt;
    }
    return fault;
  }
  return std::nullopt;
}

std::string to_text(const PlannedFault& fault) {
  return fmt::format("{}@{}x{}:{}", fault_word(fault.what), fault.layer, fault.times, fault.ms);
}

const std::vector<PrinterFault>& all_printer_faults() {
  static const std::vector<PrinterFault> kAll = [] {
    std::vector<PrinterFault> all;
    for (const auto& [one, word] : kWords) all.push_back(one);
    return all;
  }();
  return kAll;
}

}  // namespace binderjet
