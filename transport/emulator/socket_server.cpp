// SPDX-License-Identifier: GPL-3.0-or-later
// What a host controller does for a USB printer, done for a socket: whatever the printer does not
// take now is offered again, and a new connection clears halts and resets.
#include "transport/emulator/socket_server.h"

#include <poll.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <memory>
#include <utility>
#include <vector>

#include "transport/base/bytes.h"
#include "transport/base/file.h"
#include "transport/emulator/socket_frame.h"

namespace binderjet {
namespace {

constexpr std::size_t kMaxUnheard = 1 << 20;  // what a host that does not listen may leave here
constexpr int kStepsAtOnce = 64;
// The printer cannot call, so one with a host is asked again: soon at first, then 100 times a
// second, which costs no CPU to speak of.
constexpr int kFirstRetryMs = 1;
constexpr int kLastRetryMs = 10;
constexpr int kIdleMs = 100;

// One connection.
class Host {
 public:
  Host(PrinterEmulator& printer, File connection)
      : printer_(printer), connection_(std::move(connection)) {}

  int fd() const { return connection_.fd(); }
  bool greeted() const { return greeted_; }
  short events() const {
    const bool reads = in_.empty() && !leaving_;
    return static_cast<short>((reads ? POLLIN : 0) | (out_.empty() ? 0 : POLLOUT));
  }
  bool moved() const { return moved_; }

  // Moves what can be moved. False once there is nothing left to do for this host.
  bool attend() {
    moved_ = false;
    if (in_.empty() && !leaving_ && !receive()) return false;
    if (greeted_ && !ready_ && !leaving_) reset();
    for (int i = 0; i < kStepsAtOnce && ready_ && !leaving_; ++i) {
      const bool out = offer();
      const bool in = ask();
      if (!out && !in) break;
      moved_ = true;
    }
    return send_some() && !(leaving_ && out_.empty());
  }

 private:
  // False when the host has left, or is none.
  bool receive() {
    in_.resize(kSocketPiece);
    const ssize_t got = recv(fd(), in_.data(), in_.size(), MSG_DONTWAIT);
    const int error = errno;
    in_.resize(static_cast<std::size_t>(std::max<ssize_t>(got, 0)));
    if (got < 0) return error == EAGAIN || error == EINTR;
    if (got == 0) return false;
    moved_ = true;
    if (!greeted_) return take_greeting();
    if (halted_out_) in_.clear();
    return true;
  }

  bool take_greeting() {
    const auto greeting = as_bytes(kSocketGreeting);
    const std::size_t left = greeting.size() - greeting_bytes_;
    const std::size_t count = std::min(left, in_.size());
    if (!std::equal(in_.begin(), in_.begin() + static_cast<std::ptrdiff_t>(count),
                    greeting.begin() + static_cast<std::ptrdiff_t>(greeting_bytes_))) {
      return false;
    }
    greeting_bytes_ += count;
    in_.erase(in_.begin(), in_.begin() + static_cast<std::ptrdiff_t>(count));
    greeted_ = greeting_bytes_ == greeting.size();
    if (greeted_) printer_.mend();
    return true;
  }

  void reset() {
    printer_.clear_halt(0x01);
    printer_.clear_halt(0x82);
    // As a host on a bus does: SOFT_RESET, and its older form where the first is not known.
    for (const std::uint8_t type : {std::uint8_t{0x21}, std::uint8_t{0x23}}) {
      const UsbOutcome outcome = printer_.control({type, 2, 0, 0, 0}, {}).outcome;
      if (outcome == UsbOutcome::kStall) continue;
      if (outcome == UsbOutcome::kGone) part();
      if (outcome != UsbOutcome::kOk) return;
      ready_ = true;
      put_socket_frame(out_, SocketWord::kReady);
      return;
    }
  }

  // The OUT pipe; whether anything moved.
  bool offer() {
    if (in_.empty() || halted_out_ || out_.size() > kMaxUnheard) return false;
    const UsbTaken taken = printer_.bulk_out(in_);
    in_.erase(in_.begin(), in_.begin() + static_cast<std::ptrdiff_t>(taken.bytes));
    if (taken.bytes > 0) {
      put_socket_frame(out_, SocketWord::kTaken, static_cast<std::uint32_t>(taken.bytes));
    }
    if (taken.outcome == UsbOutcome::kStall) {
      halted_out_ = true;
      in_.clear();
      put_socket_frame(out_, SocketWord::kStall, 0);
    } else if (taken.outcome == UsbOutcome::kGone) {
      part();
    }
    return taken.bytes > 0;
  }

  // The IN pipe; whether anything moved.
  bool ask() {
    if (halted_in_ || leaving_ || out_.size() > kMaxUnheard) return false;
    const UsbReply reply = printer_.bulk_in(kSocketPiece);
    if (reply.outcome == UsbOutcome::kStall) {
      halted_in_ = true;
      put_socket_frame(out_, SocketWord::kStall, 1);
    } else if (reply.outcome == UsbOutcome::kGone) {
      part();
    } else if (!reply.data.empty()) {
      put_socket_frame(out_, SocketWord::kAnswer, 0, reply.data);
    }
    return reply.outcome == UsbOutcome::kOk;
  }

  void part() {
    if (std::exchange(leaving_, true)) return;
    put_socket_frame(out_, SocketWord::kGone);
  }

  // False when the host has left.
  bool send_some() {
    while (!out_.empty()) {
      const ssize_t done = send(fd(), out_.data(), out_.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
      if (done < 0 && errno == EINTR) continue;
      if (done < 0) return errno == EAGAIN;
      out_.erase(out_.begin(), out_.begin() + done);
    }
    return true;
  }

  PrinterEmulator& printer_;
  File connection_;
  std::size_t greeting_bytes_ = 0;
  bool greeted_ = false;
  bool ready_ = false;    // the printer was reset for this host
  bool leaving_ = false;  // the printer is gone: only what was said is still to be heard
  bool halted_out_ = false;
  bool halted_in_ = false;
  bool moved_ = false;
  std::vector<std::byte> in_;   // read and not yet taken
  std::vector<std::byte> out_;  // said and not yet sent
};

bool has_left(const Host& host) {
  pollfd left{host.fd(), 0, 0};
  return poll(&left, 1, 0) > 0 && (left.revents & (POLLHUP | POLLERR)) != 0;
}

void turn_away(const File& newcomer) {
  std::vector<std::byte> busy;
  put_socket_frame(busy, SocketWord::kBusy);
  static_cast<void>(send(newcomer.fd(), busy.data(), busy.size(), MSG_NOSIGNAL | MSG_DONTWAIT));
}

}  // namespace

void serve_on_socket(PrinterEmulator& printer, const PrinterSocket& socket,
                     const std::function<bool()>& stop) {
  std::unique_ptr<Host> host;
  int retry_ms = kFirstRetryMs;
  bool accepts = true;
  while (!stop()) {
    std::array<pollfd, 2> ready{
        pollfd{accepts ? socket.fd() : -1, POLLIN, 0},
        pollfd{host ? host->fd() : -1, host ? host->events() : short{0}, 0}};
    poll(ready.data(), ready.size(), host ? retry_ms : kIdleMs);
    if (host && (has_left(*host) || !host->attend())) host.reset();
    if (host) {
      retry_ms = host->moved() ? kFirstRetryMs : std::min(2 * retry_ms, kLastRetryMs);
    }
    accepts = true;
    if ((ready[0].revents & POLLIN) == 0) continue;
    File newcomer(accept4(socket.fd(), nullptr, nullptr, SOCK_CLOEXEC | SOCK_NONBLOCK));
    // Without a descriptor for it the newcomer stays, and would be seen again at once: not in the
    // next round.
    accepts = static_cast<bool>(newcomer);
    if (!newcomer) continue;
    // A program that restarts its link has closed the old one before. One that never greeted has
    // no claim.
    if (host && host->greeted() && !has_left(*host)) {
      turn_away(newcomer);
    } else {
      host = std::make_unique<Host>(printer, std::move(newcomer));
      retry_ms = kFirstRetryMs;
    }
  }
}

}  // namespace binderjet
