// SPDX-License-Identifier: GPL-3.0-or-later
// The USB/IP protocol (Documentation/usb/usbip_protocol.rst of Linux), as much as one printer
// needs. Integers are big-endian; a transfer that is not answered at once waits and is tried again.
#include "tests/printer/emulator/usbip_server.h"

#include <arpa/inet.h>
#include <fcntl.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <list>
#include <string>
#include <vector>

namespace binderjet {
namespace {

constexpr std::uint16_t kVersion = 0x0111;
constexpr std::uint16_t kAskList = 0x8005;
constexpr std::uint16_t kAskImport = 0x8003;
constexpr std::uint32_t kSubmit = 1;
constexpr std::uint32_t kUnlink = 2;
constexpr std::uint32_t kMaxTransfer = 16 << 20;
constexpr std::size_t kHeadBytes = 48;

using Bytes = std::vector<std::byte>;

void put(Bytes& out, std::uint64_t value, int bytes) {
  for (int i = bytes - 1; i >= 0; --i) {
    // Fields longer than any number are padding.
    out.push_back(i < 8 ? static_cast<std::byte>(value >> (8 * i)) : std::byte{0});
  }
}
void put_text(Bytes& out, const std::string& text, std::size_t size) {
  for (std::size_t i = 0; i < size; ++i) {
    out.push_back(i < text.size() ? static_cast<std::byte>(text[i]) : std::byte{0});
  }
}
std::uint32_t get32(std::span<const std::byte> in, std::size_t at) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < 4; ++i) value = value << 8 | static_cast<std::uint32_t>(in[at + i]);
  return value;
}

// Fills the buffer; false when the host went or `stop`.
bool receive(int fd, std::span<std::byte> in, const std::atomic<bool>& stop) {
  while (!in.empty()) {
    pollfd ready{fd, POLLIN, 0};
    if (stop) return false;
    if (poll(&ready, 1, 200) == 0) continue;
    const ssize_t got = recv(fd, in.data(), in.size(), 0);
    if (got <= 0) return false;
    in = in.subspan(static_cast<std::size_t>(got));
  }
  return true;
}
bool send_all(int fd, std::span<const std::byte> out) {
  while (!out.empty()) {
    const ssize_t done = send(fd, out.data(), out.size(), MSG_NOSIGNAL);
    if (done <= 0) return false;
    out = out.subspan(static_cast<std::size_t>(done));
  }
  return true;
}

struct Transfer {
  std::uint32_t number = 0;
  bool in = false;
  std::uint32_t endpoint = 0;
  ControlSetup setup{};
  Bytes data;
  std::size_t length = 0;
  std::size_t done = 0;
};

class Connection {
 public:
  Connection(EmulatedUsbDevice& device, int fd, const std::atomic<bool>& stop)
      : device_(device), fd_(fd), stop_(stop) {}

  void run() {
    Bytes head(8);
    if (!receive(fd_, head, stop_)) return;
    const std::uint32_t code = get32(head, 0) & 0xffff;
    if (code == kAskList) {
      Bytes out;
      put(out, kVersion, 2);
      put(out, 0x0005, 2);
      put(out, 0, 4);
      put(out, 1, 4);
      describe(out);
      put(out, 0x07010200, 4);  // the interface's class
      send_all(fd_, out);
    } else if (code == kAskImport) {
      Bytes bus(32);
      if (!receive(fd_, bus, stop_)) return;
      Bytes out;
      put(out, kVersion, 2);
      put(out, 0x0003, 2);
      put(out, 0, 4);
      describe(out);
      if (send_all(fd_, out)) run_transfers();
    }
  }

 private:
  void describe(Bytes& out) const {
    const Bytes d = device_.device_descriptor();
    const auto u8 = [&](std::size_t i) { return static_cast<std::uint64_t>(d[i]); };
    put_text(out, "/sys/devices/emulated/1-1", 256);
    put_text(out, "1-1", 32);
    put(out, 1, 4);  // bus
    put(out, 2, 4);  // device
    put(out, 3, 4);  // high speed
    put(out, u8(9) << 8 | u8(8), 2);
    put(out, u8(11) << 8 | u8(10), 2);
    put(out, u8(13) << 8 | u8(12), 2);
    put(out, u8(4), 1);
    put(out, u8(5), 1);
    put(out, u8(6), 1);
    put(out, 1, 1);  // configuration
    put(out, 1, 1);  // configurations
    put(out, 1, 1);  // interfaces
  }

  void run_transfers() {
    while (!stop_) {
      pollfd ready{fd_, POLLIN, 0};
      // While a transfer waits it is tried again every millisecond; otherwise the host wakes us.
      const int got = poll(&ready, 1, waiting_.empty() ? 200 : 1);
      if (got > 0 && !take_command()) return;
      if (!run_waiting()) return;
    }
  }

  bool take_command() {
    Bytes head(kHeadBytes);
    if (!receive(fd_, head, stop_)) return false;
    const std::uint32_t command = get32(head, 0);
    if (command == kUnlink) {
      const std::uint32_t victim = get32(head, 20);
      const auto before = waiting_.size();
      waiting_.remove_if([victim](const Transfer& one) { return one.number == victim; });
      Bytes out;
      put(out, 4, 4);
      put(out, get32(head, 4), 4);
      put(out, 0, 12);
      put(out, static_cast<std::uint32_t>(waiting_.size() < before ? -ECONNRESET : 0), 4);
      put(out, 0, 24);
      return send_all(fd_, out);
    }
    if (command != kSubmit) return false;
    Transfer one;
    one.number = get32(head, 4);
    one.in = get32(head, 12) != 0;
    one.endpoint = get32(head, 16);
    one.length = get32(head, 24);
    if (one.length > kMaxTransfer) return false;
    const auto u8 = [&](std::size_t i) { return static_cast<unsigned>(head[40 + i]); };
    one.setup = {static_cast<std::uint8_t>(u8(0)), static_cast<std::uint8_t>(u8(1)),
                 static_cast<std::uint16_t>(u8(2) | u8(3) << 8),
                 static_cast<std::uint16_t>(u8(4) | u8(5) << 8),
                 static_cast<std::uint16_t>(u8(6) | u8(7) << 8)};
    if (!one.in) {
      one.data.resize(one.length);
      if (!receive(fd_, one.data, stop_)) return false;
    }
    waiting_.push_back(std::move(one));
    return true;
  }

  bool run_waiting() {
    bool blocked[3] = {};
    for (auto one = waiting_.begin(); one != waiting_.end();) {
      const std::size_t pipe = one->endpoint == 0 ? 0 : one->in ? 1 : 2;
      Bytes answer;
      UsbOutcome outcome = UsbOutcome::kNak;
      if (!blocked[pipe]) outcome = run(*one, answer);
      if (outcome == UsbOutcome::kNak) {
        blocked[pipe] = true;
        ++one;
        continue;
      }
      const int status = outcome == UsbOutcome::kStall  ? -EPIPE
                         : outcome == UsbOutcome::kGone ? -ESHUTDOWN
                                                        : 0;
      if (!reply(*one, status, answer)) return false;
      one = waiting_.erase(one);
      if (outcome == UsbOutcome::kGone) return false;  // unplugged: the connection ends
    }
    return true;
  }

  UsbOutcome run(Transfer& one, Bytes& answer) {
    if (one.endpoint == 0) {
      UsbReply reply = device_.control(one.setup, one.data);
      one.done = one.in ? reply.data.size() : one.length;
      answer = std::move(reply.data);
      return reply.outcome;
    }
    if (one.in) {
      UsbReply reply = device_.bulk_in(one.length);
      one.done = reply.data.size();
      answer = std::move(reply.data);
      return reply.outcome;
    }
    const UsbTaken taken = device_.bulk_out(std::span(one.data).subspan(one.done));
    one.done += taken.bytes;
    return taken.outcome;
  }

  bool reply(const Transfer& one, int status, const Bytes& answer) {
    Bytes out;
    put(out, 3, 4);
    put(out, one.number, 4);
    put(out, 0, 12);
    put(out, static_cast<std::uint32_t>(status), 4);
    put(out, one.done, 4);
    put(out, 0, 4);
    put(out, 0xffffffff, 4);  // no isochronous packets
    put(out, 0, 4);
    put(out, 0, 8);
    if (one.in) out.insert(out.end(), answer.begin(), answer.end());
    return send_all(fd_, out);
  }

  EmulatedUsbDevice& device_;
  int fd_;
  const std::atomic<bool>& stop_;
  std::list<Transfer> waiting_;
};

}  // namespace

bool serve_usbip(EmulatedUsbDevice& device, int port, const std::atomic<bool>& stop) {
  const int listener = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  const int yes = 1;
  setsockopt(listener, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<std::uint16_t>(port));
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  if (bind(listener, reinterpret_cast<sockaddr*>(&address), sizeof address) != 0 ||
      listen(listener, 1) != 0) {
    close(listener);
    return false;
  }
  while (!stop) {
    pollfd ready{listener, POLLIN, 0};
    if (poll(&ready, 1, 200) <= 0) continue;
    const int fd = accept4(listener, nullptr, nullptr, SOCK_CLOEXEC);
    if (fd < 0) continue;
    Connection(device, fd, stop).run();
    close(fd);
  }
  close(listener);
  return true;
}

}  // namespace binderjet
