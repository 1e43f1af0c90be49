// SPDX-License-Identifier: GPL-3.0-or-later
// What an emulated printer says to its host over a socket (PROTOCOL.md, section 9): pieces of the
// IN pipe, and what a bus tells a host of its transfers.
//
//   head, 8 bytes   magic 3 "BJE" | kind 1 | n 4, little-endian
//   data, n bytes   where the kind is kAnswer
//
// The other direction is kSocketGreeting and then the bytes of the OUT pipe, without frames.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

namespace binderjet {

inline constexpr std::string_view kSocketGreeting = "BJE1";
inline constexpr std::size_t kSocketPiece = 64 << 10;  // the longest data of a frame

enum class SocketWord : std::uint8_t {
  kReady = 'R',   // both pipes are empty and reset; first of all
  kBusy = 'B',    // another host has the printer
  kTaken = 'T',   // n bytes more of the OUT pipe were taken
  kAnswer = 'A',  // n bytes of the IN pipe follow
  kStall = 'S',   // halted: n = 0 the OUT pipe, 1 the IN pipe
  kGone = 'G',    // unplugged or switched off
};

struct SocketFrame {
  SocketWord word = SocketWord::kReady;
  std::uint32_t number = 0;
  std::vector<std::byte> data;
};

void put_socket_frame(std::vector<std::byte>& out, SocketWord word, std::uint32_t number = 0,
                      std::span<const std::byte> data = {});

// Takes bytes as they come. A head that is none, or one that claims too much, ends it: from then on
// wrong() is true, and no frame comes any more.
class SocketFrames {
 public:
  void feed(std::span<const std::byte> bytes);
  std::optional<SocketFrame> next();
  bool wrong() const { return wrong_; }
  void reset();

 private:
  std::vector<std::byte> buffer_;  // what is no whole frame yet, from at_ on
  std::size_t at_ = 0;
  bool wrong_ = false;
};

}  // namespace binderjet
