// SPDX-License-Identifier: GPL-3.0-or-later
#include "transport/emulator/socket_link.h"

#include <poll.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <utility>

#include "transport/base/bytes.h"
#include "transport/emulator/printer_socket.h"

namespace binderjet {
namespace {

constexpr auto kReadyTime = std::chrono::seconds(1);
constexpr std::size_t kMaxInput = 1 << 20;  // a printer that says more unasked is out of its mind

int poll_ms(PrinterLink::Clock::time_point until) {
  const auto left = std::chrono::ceil<std::chrono::milliseconds>(until - PrinterLink::Clock::now());
  return static_cast<int>(std::clamp<std::int64_t>(left.count(), 0, 1000));
}

}  // namespace

Result<std::unique_ptr<PrinterLink>> SocketLink::open(const std::string& folder,
                                                      const std::string& uri) {
  Result<File> connection = connect_to_printer(folder);
  if (!connection) return tl::unexpected(connection.error());
  return std::make_unique<SocketLink>(folder, uri, std::move(*connection));
}

SocketLink::SocketLink(std::string folder, std::string uri, File connection)
    : folder_(std::move(folder)), uri_(std::move(uri)), connection_(std::move(connection)) {}

void SocketLink::set_state(LinkState state, const std::string& why) {
  if (state_ == LinkState::kGone || (state_ == LinkState::kBroken && state != LinkState::kGone)) {
    return;
  }
  state_ = state;
  trouble_ = why;
}

void SocketLink::post(std::vector<std::byte> bytes) {
  out_.erase(out_.begin(), out_.begin() + static_cast<std::ptrdiff_t>(out_at_));
  out_at_ = 0;
  out_.insert(out_.end(), bytes.begin(), bytes.end());
  posted_ += bytes.size();
  send_some();
}

std::vector<std::byte> SocketLink::take_input() {
  move_bytes(Clock::now());
  return std::exchange(input_, {});
}

void SocketLink::wait(Clock::time_point until) {
  while (input_.empty() && state_ == LinkState::kFine) {
    move_bytes(until);
    if (Clock::now() >= until) return;
  }
}

bool SocketLink::move_bytes(Clock::time_point until) {
  if (state_ == LinkState::kGone) return false;
  const bool sends = out_at_ < out_.size() && state_ == LinkState::kFine;
  pollfd ready{connection_.fd(), static_cast<short>(POLLIN | (sends ? POLLOUT : 0)), 0};
  if (poll(&ready, 1, poll_ms(until)) <= 0) return false;
  if ((ready.revents & POLLOUT) != 0) send_some();
  if ((ready.revents & (POLLIN | POLLHUP | POLLERR)) != 0) receive_some();
  return true;
}

void SocketLink::send_some() {
  while (out_at_ < out_.size() && state_ == LinkState::kFine) {
    const ssize_t done = send(connection_.fd(), out_.data() + out_at_, out_.size() - out_at_,
                              MSG_NOSIGNAL | MSG_DONTWAIT);
    if (done < 0 && errno == EINTR) continue;
    // That the other side has closed is found by reading: its last words come first.
    if (done <= 0) return;
    out_at_ += static_cast<std::size_t>(done);
  }
}

void SocketLink::receive_some() {
  std::array<std::byte, kSocketPiece> piece;
  const ssize_t got = recv(connection_.fd(), piece.data(), piece.size(), MSG_DONTWAIT);
  if (got < 0 && (errno == EINTR || errno == EAGAIN)) return;
  if (got <= 0) {
    set_state(LinkState::kGone,
              "the emulated printer has ended, and what it held with it; print again");
    return;
  }
  frames_.feed(std::span(piece).first(static_cast<std::size_t>(got)));
  while (std::optional<SocketFrame> frame = frames_.next()) take(std::move(*frame));
  if (frames_.wrong()) {
    set_state(LinkState::kGone, "what listens there is no emulated printer");
  } else if (input_.size() > kMaxInput) {
    set_state(LinkState::kBroken, "the printer talks without end");
  }
}

void SocketLink::take(SocketFrame frame) {
  switch (frame.word) {
    case SocketWord::kReady:
      ready_ = true;
      break;
    case SocketWord::kBusy:
      set_state(LinkState::kGone, "another program uses it; let that one finish, or stop it");
      break;
    case SocketWord::kTaken:
      if (frame.number > posted_ - taken_) {
        set_state(LinkState::kBroken, "the printer takes more than it was sent");
      } else {
        taken_ += frame.number;
      }
      break;
    case SocketWord::kAnswer:
      input_.insert(input_.end(), frame.data.begin(), frame.data.end());
      break;
    case SocketWord::kStall:
      set_state(LinkState::kBroken, frame.number == 0 ? "the printer stalled its data pipe"
                                                      : "the printer stalled its answering pipe");
      break;
    case SocketWord::kGone:
      set_state(LinkState::kGone, "the printer was unplugged or switched off");
      break;
  }
}

bool SocketLink::restart() {
  if (state_ == LinkState::kGone) return false;
  if (std::exchange(used_, true)) {
    connection_ = {};  // closed first: the printer has one host at a time
    Result<File> again = connect_to_printer(folder_);
    if (!again) {
      set_state(LinkState::kGone, again.error().what);
      return false;
    }
    connection_ = std::move(*again);
  }
  state_ = LinkState::kFine;
  trouble_.clear();
  ready_ = false;
  frames_.reset();
  input_.clear();
  out_.clear();
  out_at_ = 0;
  const auto greeting = as_bytes(kSocketGreeting);
  out_.assign(greeting.begin(), greeting.end());
  posted_ = taken_;
  send_some();
  const auto until = Clock::now() + kReadyTime;
  while (!ready_ && state_ == LinkState::kFine && Clock::now() < until) move_bytes(until);
  return ready_ && state_ == LinkState::kFine;
}

}  // namespace binderjet
