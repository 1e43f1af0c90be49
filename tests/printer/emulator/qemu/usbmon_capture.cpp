// SPDX-License-Identifier: GPL-3.0-or-later
// Writes what the kernel's usbmon sees on all USB buses to a pcap file, every byte or an error.
//
//   usbmon_capture FILE [DEVICE]
//
// Says "ready" on stdout once nothing can be missed; SIGTERM ends it. Exit status 1 if the kernel
// dropped or cut anything.
#include <fcntl.h>
#include <poll.h>
#include <sched.h>
#include <sys/ioctl.h>
#include <sys/signalfd.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <vector>

namespace {

// The kernel's binary interface (Documentation/usb/usbmon.rst); no header exports it.
struct EventHead {
  std::uint64_t id;
  std::uint8_t type, transfer_type, endpoint, device;
  std::uint16_t bus;
  char has_setup, has_data;
  std::int64_t seconds;
  std::int32_t microseconds, status;
  std::uint32_t urb_bytes, captured_bytes;
  std::array<std::uint8_t, 24> more;
};
static_assert(sizeof(EventHead) == 64);
struct GetEvent {
  EventHead* head;
  void* data;
  std::size_t room;
};
struct Stats {
  std::uint32_t queued, dropped;
};
constexpr unsigned long kStats = _IOR(0x92, 3, Stats);
constexpr unsigned long kSetRingBytes = _IO(0x92, 4);
constexpr unsigned long kGetEvent = _IOW(0x92, 10, GetEvent);
constexpr int kRingBytes = 1200 * 1024;  // the most it gives; one event gets a fifth of it

struct PcapHead {
  std::uint32_t magic = 0xa1b2c3d4;
  std::uint16_t major = 2, minor = 4;
  std::uint32_t zone = 0, accuracy = 0;
  std::uint32_t max_bytes = 262144;
  std::uint32_t link_type = 220;  // usbmon's 64-byte heads
};
struct PacketHead {
  std::uint32_t seconds, microseconds, captured_bytes, bytes;
};

template <typename T>
bool put(std::FILE* file, const T& value) {
  return std::fwrite(&value, sizeof(value), 1, file) == 1;
}

int failed(const char* what) {
  std::fprintf(stderr, "usbmon_capture: %s: %s\n", what, std::strerror(errno));
  return 1;
}

// How many bytes the event moved; an OUT transfer shows them when it is submitted, an IN transfer
// when it is complete.
bool is_cut(const EventHead& head) {
  const bool shows = (head.endpoint & 0x80) != 0 ? head.type == 'C' : head.type == 'S';
  return shows && head.transfer_type == 3 && head.captured_bytes < head.urb_bytes;
}

// All that is queued goes to the file. -1 on an error, else how many events were cut.
int drain(int monitor, std::vector<char>& data, std::FILE* file) {
  int cut = 0;
  for (;;) {
    EventHead head{};
    GetEvent get{&head, data.data(), data.size()};
    if (ioctl(monitor, kGetEvent, &get) != 0) return errno == EAGAIN ? cut : -1;
    cut += is_cut(head) ? 1 : 0;
    const auto bytes = static_cast<std::uint32_t>(sizeof(head)) + head.captured_bytes;
    const PacketHead packet{static_cast<std::uint32_t>(head.seconds),
                            static_cast<std::uint32_t>(head.microseconds), bytes, bytes};
    if (!put(file, packet) || !put(file, head) ||
        std::fwrite(data.data(), 1, head.captured_bytes, file) != head.captured_bytes) {
      return -1;
    }
  }
}

}  // namespace

int main(int count, char** words) {
  if (count < 2) return failed("usage: usbmon_capture FILE [DEVICE]");
  sigset_t end;
  sigemptyset(&end);
  sigaddset(&end, SIGTERM);
  sigprocmask(SIG_BLOCK, &end, nullptr);
  const int ends = signalfd(-1, &end, 0);
  const char* device = count > 2 ? words[2] : "/dev/usbmon0";
  const int monitor = open(device, O_RDONLY | O_NONBLOCK);
  if (ends < 0 || monitor < 0) return failed(device);
  if (ioctl(monitor, kSetRingBytes, kRingBytes) != 0) return failed("the ring");
  // The ring holds less than what may be in flight twice: whoever empties it comes first.
  const sched_param first{.sched_priority = 10};
  if (sched_setscheduler(0, SCHED_FIFO, &first) != 0) return failed("real-time priority");

  std::FILE* file = std::fopen(words[1], "wb");
  if (file == nullptr || !put(file, PcapHead{})) return failed(words[1]);
  std::puts("ready");
  std::fflush(stdout);

  std::vector<char> data(kRingBytes);
  int cut = 0;
  for (bool ended = false; !ended;) {
    std::array<pollfd, 2> wait{pollfd{monitor, POLLIN, 0}, pollfd{ends, POLLIN, 0}};
    if (poll(wait.data(), wait.size(), -1) < 0 && errno != EINTR) return failed("poll");
    ended = wait[1].revents != 0;
    const int more = drain(monitor, data, file);
    if (more < 0) return failed(words[1]);
    cut += more;
  }
  Stats stats{};
  if (ioctl(monitor, kStats, &stats) != 0 || std::fclose(file) != 0) return failed(words[1]);
  std::fprintf(stderr, "usbmon_capture: %u events dropped, %d cut\n", stats.dropped, cut);
  return stats.dropped == 0 && cut == 0 ? 0 : 1;
}
