// SPDX-License-Identifier: GPL-3.0-or-later
// The socket and the loop of a usb-redir connection.
#include "tests/printer/emulator/usbredir_serve.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>

#include "tests/printer/emulator/usbredir_port.h"

namespace binderjet {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::chrono::seconds kAppearTime{10};
constexpr int kConnectRetryMs = 10;
// A device cannot call out, so one that NAKs is asked again: soon at first, then 100 times a
// second, which costs no measurable CPU.
constexpr int kFirstRetryMs = 1;
constexpr int kLastRetryMs = 10;

class Socket {
 public:
  explicit Socket(int fd) : fd_(fd) {}
  ~Socket() {
    if (fd_ >= 0) close(fd_);
  }
  Socket(const Socket&) = delete;
  Socket& operator=(const Socket&) = delete;
  int fd() const { return fd_; }

 private:
  int fd_;
};

UsbredirResult failed(const std::string& what) { return {UsbredirEnd::kFailed, what}; }

// Waits for the stop, at most `timeout_ms`.
bool stops(int stop_fd, int timeout_ms) {
  pollfd wait{stop_fd, POLLIN, 0};
  return poll(&wait, 1, timeout_ms) > 0;
}

}  // namespace

UsbredirResult serve_usbredir(EmulatedUsbDevice& device, const std::string& socket_path,
                              int stop_fd) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (socket_path.size() >= sizeof(address.sun_path)) {
    return failed(socket_path + ": longer than a socket's name may be");
  }
  std::copy(socket_path.begin(), socket_path.end(), address.sun_path);
  const auto deadline = Clock::now() + kAppearTime;
  for (;;) {
    const int fd = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
    if (fd < 0) return failed(std::strerror(errno));
    if (connect(fd, reinterpret_cast<const sockaddr*>(&address), sizeof(address)) == 0) {
      return serve_usbredir_on(device, fd, stop_fd);
    }
    const int error = errno;
    close(fd);
    // Nothing announces that a socket listens.
    if ((error != ENOENT && error != ECONNREFUSED) || Clock::now() >= deadline) {
      return failed(socket_path + ": " + std::strerror(error));
    }
    if (stops(stop_fd, kConnectRetryMs)) return {};
  }
}

UsbredirResult serve_usbredir_on(EmulatedUsbDevice& device, int socket, int stop_fd) {
  const Socket owner(socket);
  if (fcntl(socket, F_SETFL, O_NONBLOCK) != 0) return failed(std::strerror(errno));
  UsbredirPort port(device, socket);
  int retry_ms = kFirstRetryMs;
  for (;;) {
    const bool moved = port.attend();
    if (port.wants_to_write() && !port.write()) return {UsbredirEnd::kPeerClosed, {}};
    if (port.parted()) return {UsbredirEnd::kGone, {}};

    retry_ms = moved ? kFirstRetryMs : std::min(2 * retry_ms, kLastRetryMs);
    const short events = static_cast<short>(POLLIN | (port.wants_to_write() ? POLLOUT : 0));
    std::array<pollfd, 2> wait{pollfd{socket, events, 0}, pollfd{stop_fd, POLLIN, 0}};
    if (poll(wait.data(), wait.size(), port.waiting() ? retry_ms : -1) < 0 && errno != EINTR) {
      return failed(std::strerror(errno));
    }
    if (wait[1].revents != 0) return {UsbredirEnd::kStopped, {}};
    if (wait[0].revents != 0 && !port.read()) {
      if (!port.complaint().empty()) return failed(port.complaint());
      return {port.gone() ? UsbredirEnd::kGone : UsbredirEnd::kPeerClosed, {}};
    }
  }
}

}  // namespace binderjet
