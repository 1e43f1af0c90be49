// SPDX-License-Identifier: GPL-3.0-or-later
// What binderjet and binderjet-read say to each other over their socket: a request and its content,
// a reply and its content, until the socket is closed. Both come from one build on one machine, so
// numbers are as the processor has them; what the reader says is checked as a stranger's word.
#pragma once

#include <sys/socket.h>

#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <span>

namespace binderjet {

enum class ImageWish : std::uint32_t { kSize, kGray, kColor };

struct ImageRequest {
  static constexpr std::uint32_t kMagic = 0x31524a42;  // BJR1
  std::uint32_t magic = kMagic;
  ImageWish wish = ImageWish::kSize;
  std::uint32_t factor = 1;
  std::uint32_t is_path = 0;  // the content is the file's path, else the file's bytes
  std::uint64_t size = 0;     // of the content, bytes
};

struct ImageReply {
  std::uint32_t magic = ImageRequest::kMagic;
  std::uint32_t good = 0;  // else the content says in words what is wrong
  std::int32_t width = 0;
  std::int32_t height = 0;
  std::uint64_t size = 0;  // of the content, bytes
};

// An image has at most so many pixels.
constexpr std::int64_t kMostPixels = std::int64_t{1} << 31;

// The whole of it, or false where the other side is gone; no signal tells of that.
inline bool send_all(int socket, std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    const ssize_t sent = ::send(socket, bytes.data(), bytes.size(), MSG_NOSIGNAL);
    if (sent < 0 && errno == EINTR) continue;
    if (sent <= 0) return false;
    bytes = bytes.subspan(static_cast<std::size_t>(sent));
  }
  return true;
}

inline bool receive_all(int socket, std::span<std::byte> bytes) {
  while (!bytes.empty()) {
    const ssize_t received = ::recv(socket, bytes.data(), bytes.size(), 0);
    if (received < 0 && errno == EINTR) continue;
    if (received <= 0) return false;
    bytes = bytes.subspan(static_cast<std::size_t>(received));
  }
  return true;
}

}  // namespace binderjet
