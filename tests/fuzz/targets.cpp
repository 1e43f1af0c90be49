// SPDX-License-Identifier: GPL-3.0-or-later
// A decoder's word: it reads nothing beyond its input, keeps no more than its bound, and what it
// takes it can say again.
#include "tests/fuzz/targets.h"

#include <algorithm>
#include <cstdlib>
#include <span>
#include <string_view>

#include "transport/base/bytes.h"
#include "transport/emulator/printer_emulator.h"
#include "transport/job/job_format.h"
#include "transport/printer/frame.h"
#include "transport/printer/protocol.h"
#include "transport/usb/usb_quirks.h"

namespace binderjet {
namespace {

using protocol::Frame;
using protocol::FrameDecoder;

constexpr std::size_t kBound = 4096;

std::span<const std::byte> bytes_of(const std::uint8_t* data, std::size_t size) {
  return std::as_bytes(std::span(data, size));
}

// All frames up to the first fault, fed in steps of `step` bytes.
std::vector<Frame> frames_of(std::span<const std::byte> bytes, std::size_t step, bool& fault) {
  FrameDecoder decoder(kBound);
  std::vector<Frame> frames;
  while (!bytes.empty() && decoder.fault().empty()) {
    const auto part = bytes.first(std::min(step, bytes.size()));
    const std::size_t taken = decoder.feed(part);
    require(taken <= part.size());
    bytes = bytes.subspan(taken);
    const bool was_stuck = taken == 0;
    if (auto frame = decoder.take_frame()) {
      require(frame->payload.size() <= kBound);
      frames.push_back(std::move(*frame));
    } else {
      require(!was_stuck || !decoder.fault().empty());
    }
  }
  fault = !decoder.fault().empty();
  return frames;
}

template <class Message>
void says_again(const std::optional<Message>& message,
                std::optional<Message> (*decode)(std::span<const std::byte>)) {
  if (!message) return;
  const std::vector<std::byte> once = protocol::encode(*message);
  const auto again = decode(once);
  require(again && protocol::encode(*again) == once);
}

}  // namespace

void fuzz_frames(const std::uint8_t* data, std::size_t size) {
  const auto bytes = bytes_of(data, size);
  bool fault = false;
  bool fault_by_byte = false;
  const auto frames = frames_of(bytes, size + 1, fault);
  const auto by_byte = frames_of(bytes, 1, fault_by_byte);
  require(fault == fault_by_byte && frames.size() == by_byte.size());
  std::size_t end = 0;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    require(frames[i].payload == by_byte[i].payload && frames[i].type == by_byte[i].type);
    const auto again =
        protocol::encode_frame(frames[i].type, frames[i].sequence, frames[i].payload);
    require(std::equal(again.begin(), again.end(), bytes.begin() + static_cast<long>(end)));
    end += again.size();
  }
  if (const auto found = protocol::find_frame(bytes, protocol::Type::kWelcome, kBound)) {
    require(found->end <= size);
  }
}

void fuzz_messages(const std::uint8_t* data, std::size_t size) {
  const auto bytes = bytes_of(data, size);
  says_again(protocol::decode_hello(bytes), protocol::decode_hello);
  says_again(protocol::decode_welcome(bytes), protocol::decode_welcome);
  says_again(protocol::decode_job(bytes), protocol::decode_job);
  says_again(protocol::decode_resume(bytes), protocol::decode_resume);
  says_again(protocol::decode_progress(bytes), protocol::decode_progress);
  says_again(protocol::decode_layer_head(bytes), protocol::decode_layer_head);
  says_again(protocol::decode_totals(bytes), protocol::decode_totals);
  says_again(protocol::decode_status(bytes), protocol::decode_status);
  says_again(protocol::decode_refused(bytes), protocol::decode_refused);
  static_cast<void>(protocol::decode_key(bytes));
}

void fuzz_usb_texts(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  for (const bool swapped : {false, true}) {
    UsbQuirks quirks;
    quirks.device_id_little_endian = swapped;
    const std::string id = device_id_text(text, quirks);
    require(id.size() <= size);
    for (const char* key : {"MFG", "MDL", "CMD", "SER"}) {
      require(device_id_value(id, key).size() <= id.size());
    }
  }
  static_cast<void>(parse_usb_model_words(text));
}

void fuzz_records(const std::uint8_t* data, std::size_t size) {
  const auto bytes = bytes_of(data, size);
  if (const auto head = job_format::decode_record_head(bytes)) {
    const auto again = job_format::encode_record_head(*head);
    require(std::equal(again.begin(), again.end(), bytes.begin()));
  }
  static_cast<void>(job_format::decode_preamble(bytes));
  if (const auto trailer = job_format::decode_trailer(bytes)) {
    static_cast<void>(
        job_format::decode_index(bytes.subspan(job_format::kTrailerBytes), *trailer, 0, 0));
  }
}

void fuzz_printer(const std::uint8_t* data, std::size_t size) {
  PrinterEmulator printer;
  // Two bytes choose a message of the session, so that the fuzzer need not guess checksums; the
  // rest of the input is payload, and then raw bytes.
  std::uint32_t sequence = 0;
  std::span<const std::byte> rest = bytes_of(data, size);
  while (rest.size() >= 2) {
    const auto type = static_cast<protocol::Type>(rest[0]);
    const std::size_t length = std::min(static_cast<std::size_t>(rest[1]), rest.size() - 2);
    const auto frame = protocol::encode_frame(type, sequence++, rest.subspan(2, length));
    require(printer.bulk_out(frame).bytes == frame.size());
    rest = rest.subspan(2 + length);
    while (printer.bulk_in(512).outcome == UsbOutcome::kOk) {
    }
  }
  require(printer.bulk_out(bytes_of(data, size)).bytes == size);
  require(printer.sent_again() == 0 || printer.acknowledged() > 0);
}

}  // namespace binderjet
