// SPDX-License-Identifier: GPL-3.0-or-later
// Heads are checked before their length is believed, payloads before anybody sees them.
#include "transport/printer/frame.h"

#include <fmt/core.h>

#include <algorithm>
#include <utility>

#include "transport/base/bytes.h"

namespace binderjet::protocol {
namespace {

using View = std::span<const std::byte>;

constexpr std::uint32_t kMagic = 0x31554a42;  // "BJU1"

struct Head {
  Type type;
  std::uint32_t sequence;
  std::uint32_t payload_bytes;
};

bool is_head(View bytes) {
  return bytes.size() >= kFrameHeadBytes && get_le<std::uint32_t>(bytes, 0) == kMagic &&
         get_le<std::uint64_t>(bytes, 24) == checksum(bytes.first(24)) &&
         get_le<std::uint32_t>(bytes, 4) <= 0xff;
}

Head decode_head(View bytes) {
  return Head{static_cast<Type>(get_le<std::uint8_t>(bytes, 4)), get_le<std::uint32_t>(bytes, 8),
              get_le<std::uint32_t>(bytes, 12)};
}

}  // namespace

std::vector<std::byte> encode_frame(Type type, std::uint32_t sequence, View payload, View more) {
  std::vector<std::byte> out;
  out.reserve(kFrameHeadBytes + payload.size() + more.size());
  out.resize(kFrameHeadBytes);
  out.insert(out.end(), payload.begin(), payload.end());
  out.insert(out.end(), more.begin(), more.end());
  std::vector<std::byte> head;
  put_le(head, kMagic);
  put_le<std::uint32_t>(head, static_cast<std::uint8_t>(type));
  put_le(head, sequence);
  put_le(head, static_cast<std::uint32_t>(payload.size() + more.size()));
  put_le(head, checksum(View(out).subspan(kFrameHeadBytes)));
  put_le(head, checksum(head));
  std::copy(head.begin(), head.end(), out.begin());
  return out;
}

std::size_t FrameDecoder::feed(View bytes) {
  std::size_t taken = 0;
  while (taken < bytes.size() && fault_.empty() && !frame_) {
    const std::size_t wanted =
        kFrameHeadBytes + (buffer_.size() < kFrameHeadBytes ? 0 : payload_bytes_);
    const View part = bytes.subspan(taken, std::min(bytes.size() - taken, wanted - buffer_.size()));
    buffer_.insert(buffer_.end(), part.begin(), part.end());
    taken += part.size();
    if (buffer_.size() < wanted) break;
    if (buffer_.size() == kFrameHeadBytes) look_at_head();
    if (fault_.empty() && buffer_.size() == kFrameHeadBytes + payload_bytes_) look_at_payload();
  }
  return taken;
}

void FrameDecoder::look_at_head() {
  if (!is_head(buffer_)) {
    fault_ = "bytes that are no frame";
    return;
  }
  payload_bytes_ = decode_head(buffer_).payload_bytes;
  if (payload_bytes_ > max_payload_) {
    fault_ = fmt::format("a frame of {} bytes where {} are the most", payload_bytes_, max_payload_);
  }
}

void FrameDecoder::look_at_payload() {
  const Head head = decode_head(buffer_);
  const View payload = View(buffer_).subspan(kFrameHeadBytes);
  if (checksum(payload) != get_le<std::uint64_t>(buffer_, 16)) {
    fault_ = "a frame with a wrong checksum";
    return;
  }
  frame_ = Frame{head.type, head.sequence, {payload.begin(), payload.end()}};
  buffer_.clear();
  payload_bytes_ = 0;
}

std::optional<Frame> FrameDecoder::take_frame() { return std::exchange(frame_, std::nullopt); }

void FrameDecoder::reset() {
  buffer_.clear();
  payload_bytes_ = 0;
  frame_.reset();
  fault_.clear();
}

std::optional<FoundFrame> find_frame(View bytes, Type type, std::size_t max_payload,
                                     std::size_t from) {
  for (std::size_t at = from; at + kFrameHeadBytes <= bytes.size(); ++at) {
    const View here = bytes.subspan(at);
    if (!is_head(here)) continue;
    const Head head = decode_head(here);
    if (head.type != type || head.payload_bytes > max_payload ||
        here.size() - kFrameHeadBytes < head.payload_bytes) {
      continue;
    }
    const View payload = here.subspan(kFrameHeadBytes, head.payload_bytes);
    if (checksum(payload) != get_le<std::uint64_t>(here, 16)) continue;
    return FoundFrame{{head.type, head.sequence, {payload.begin(), payload.end()}},
                      at + kFrameHeadBytes + payload.size()};
  }
  return std::nullopt;
}

}  // namespace binderjet::protocol
