// SPDX-License-Identifier: GPL-3.0-or-later
#include "transport/emulator/socket_frame.h"

#include "transport/base/bytes.h"

namespace binderjet {
namespace {

constexpr std::size_t kHeadBytes = 8;
constexpr std::uint32_t kMagic = 0x454a42;  // "BJE"

bool is_word(std::uint8_t byte) {
  switch (static_cast<SocketWord>(byte)) {
    case SocketWord::kReady:
    case SocketWord::kBusy:
    case SocketWord::kTaken:
    case SocketWord::kAnswer:
    case SocketWord::kStall:
    case SocketWord::kGone:
      return true;
  }
  return false;
}

}  // namespace

void put_socket_frame(std::vector<std::byte>& out, SocketWord word, std::uint32_t number,
                      std::span<const std::byte> data) {
  put_le(out, kMagic | static_cast<std::uint32_t>(word) << 24);
  put_le(out, word == SocketWord::kAnswer ? static_cast<std::uint32_t>(data.size()) : number);
  out.insert(out.end(), data.begin(), data.end());
}

void SocketFrames::feed(std::span<const std::byte> bytes) {
  buffer_.erase(buffer_.begin(), buffer_.begin() + static_cast<std::ptrdiff_t>(at_));
  at_ = 0;
  buffer_.insert(buffer_.end(), bytes.begin(), bytes.end());
}

std::optional<SocketFrame> SocketFrames::next() {
  const std::span<const std::byte> rest = std::span(buffer_).subspan(at_);
  if (wrong_ || rest.size() < kHeadBytes) return std::nullopt;
  const auto head = get_le<std::uint32_t>(rest, 0);
  const auto number = get_le<std::uint32_t>(rest, 4);
  const auto word = static_cast<SocketWord>(head >> 24);
  const std::size_t bytes = word == SocketWord::kAnswer ? number : 0;
  if ((head & 0xffffff) != kMagic || !is_word(static_cast<std::uint8_t>(head >> 24)) ||
      bytes > kSocketPiece) {
    wrong_ = true;
    return std::nullopt;
  }
  if (rest.size() - kHeadBytes < bytes) return std::nullopt;
  const auto data = rest.subspan(kHeadBytes, bytes);
  at_ += kHeadBytes + bytes;
  return SocketFrame{word, number, {data.begin(), data.end()}};
}

void SocketFrames::reset() { *this = {}; }

}  // namespace binderjet
