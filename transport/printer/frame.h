// SPDX-License-Identifier: GPL-3.0-or-later
// The frames of binderjet-1 (PROTOCOL.md): how a message travels in a stream of bytes.
//
//   head, 32 bytes   magic 4 "BJU1" | type 1 | 0 3 | sequence 4 | payload length n 4 |
//                    checksum 8 of the payload | checksum 8 of the 24 bytes before
//   payload, n bytes
//
// The head has a checksum of its own, because a length must be believed before its payload can be
// waited for: a damaged length would make a session wait for bytes that never come.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "transport/printer/protocol.h"

namespace binderjet::protocol {

inline constexpr std::size_t kFrameHeadBytes = 32;

struct Frame {
  Type type = Type::kHello;
  std::uint32_t sequence = 0;
  std::vector<std::byte> payload;
};

// Head and payload. The payload's parts are given apart so that a layer is copied once only.
std::vector<std::byte> encode_frame(Type type, std::uint32_t sequence,
                                    std::span<const std::byte> payload,
                                    std::span<const std::byte> more = {});

// Takes bytes as they come and gives whole frames. A length is a claim: a frame longer than the
// bound is a fault before a byte of it is kept, and room grows only with bytes that came.
class FrameDecoder {
 public:
  explicit FrameDecoder(std::size_t max_payload) : max_payload_(max_payload) {}

  // Takes bytes up to the end of one frame at most; returns how many. After a fault, or while a
  // frame waits for take_frame, it takes none.
  std::size_t feed(std::span<const std::byte> bytes);
  std::optional<Frame> take_frame();
  // Empty, or what is wrong; only reset() helps.
  const std::string& fault() const { return fault_; }
  // Between two frames: nothing half is kept.
  bool idle() const { return buffer_.empty(); }
  void reset();

 private:
  void look_at_head();
  void look_at_payload();

  std::size_t max_payload_;
  std::size_t payload_bytes_ = 0;
  std::vector<std::byte> buffer_;
  std::optional<Frame> frame_;
  std::string fault_;
};

// A whole, right frame of this type anywhere in the bytes: how a session begins behind whatever an
// earlier one left. Returns it and where it ends.
struct FoundFrame {
  Frame frame;
  std::size_t end = 0;
};
std::optional<FoundFrame> find_frame(std::span<const std::byte> bytes, Type type,
                                     std::size_t max_payload, std::size_t from = 0);

}  // namespace binderjet::protocol
