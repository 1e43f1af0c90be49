// SPDX-License-Identifier: GPL-3.0-or-later
// usbfs as libusb sees it: ioctls of a node, answered by an emulated device.
//
// The node of umockdev is a plain file, which poll() finds ready at all times, so libusb would
// spin. A FIFO takes its place: while a page of it is full it is not writable, which means that
// nothing is to be reaped; it is emptied when a transfer is done.
#include "tests/printer/emulator/umockdev_bus.h"

#include <fcntl.h>
#include <fmt/core.h>
#include <linux/usbdevice_fs.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <umockdev.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <condition_variable>
#include <cstdlib>
#include <cstring>
#include <deque>
#include <filesystem>
#include <list>
#include <mutex>
#include <stdexcept>
#include <thread>
#include <vector>

namespace binderjet {
namespace {

constexpr const char* kNode = "/dev/bus/usb/001/002";
constexpr const char* kSysPath = "/sys/devices/usb1/1-1";
constexpr auto kNakPause = std::chrono::milliseconds(1);

std::string hex(std::span<const std::byte> bytes) {
  std::string text;
  for (const std::byte b : bytes) text += fmt::format("{:02X}", static_cast<unsigned>(b));
  return text;
}

std::span<const std::byte> view(const UMockdevIoctlData* data) {
  return {reinterpret_cast<const std::byte*>(data->data), static_cast<std::size_t>(data->data_len)};
}

struct Urb {
  UMockdevIoctlClient* client = nullptr;  // whose it is; never looked into
  UMockdevIoctlData* urb = nullptr;
  UMockdevIoctlData* buffer = nullptr;
  gulong address = 0;
  std::size_t done = 0;

  const usbdevfs_urb& head() const { return *reinterpret_cast<const usbdevfs_urb*>(urb->data); }

  ~Urb() {
    if (urb != nullptr) g_object_unref(urb);
    if (buffer != nullptr) g_object_unref(buffer);
  }
};

}  // namespace

struct UmockdevBus::State {
  explicit State(EmulatedUsbDevice& usb) : device(usb) {}

  EmulatedUsbDevice& device;
  UMockdevTestbed* testbed = nullptr;
  UMockdevIoctlBase* handler = nullptr;
  int fifo = -1;

  mutable std::mutex mutex;
  std::condition_variable work;
  std::list<std::unique_ptr<Urb>> pending;  // in the order they were submitted
  std::list<std::unique_ptr<Urb>> finished;
  bool full = false;  // the FIFO
  bool quit = false;
  bool busy = false;
  bool usblp = false;
  bool detached = false;
  std::size_t max_bytes = 0;
  int empty_reaps = 0;
  std::size_t max_in_flight = 0;
  std::thread pump;

  void set_nothing_to_reap() {
    if (fifo < 0) return;
    const bool wanted = finished.empty();
    char byte = 0;
    if (wanted && !full) full = write(fifo, &byte, 1) == 1;
    if (!wanted && full) full = read(fifo, &byte, 1) != 1;
  }

  void finish(std::list<std::unique_ptr<Urb>>::iterator at, int status) {
    Urb& urb = **at;
    const std::size_t setup = urb.head().type == USBDEVFS_URB_TYPE_CONTROL ? 8 : 0;
    int length = static_cast<int>(urb.done - std::min(urb.done, setup));
    umockdev_ioctl_data_update(urb.urb, offsetof(usbdevfs_urb, status),
                               reinterpret_cast<guint8*>(&status), sizeof status);
    umockdev_ioctl_data_update(urb.urb, offsetof(usbdevfs_urb, actual_length),
                               reinterpret_cast<guint8*>(&length), sizeof length);
    finished.splice(finished.end(), pending, at);
    set_nothing_to_reap();
  }

  // True if the transfer is over.
  bool run_control(std::list<std::unique_ptr<Urb>>::iterator at) {
    Urb& urb = **at;
    const auto bytes = view(urb.buffer);
    const auto u8 = [&](std::size_t i) { return static_cast<std::uint8_t>(bytes[i]); };
    const auto u16 = [&](std::size_t i) {
      return static_cast<std::uint16_t>(u8(i) | u8(i + 1) << 8);
    };
    const ControlSetup setup{u8(0), u8(1), u16(2), u16(4), u16(6)};
    UsbReply reply = device.control(setup, bytes.subspan(8));
    if (reply.outcome == UsbOutcome::kNak) return false;
    if (!reply.data.empty()) {
      umockdev_ioctl_data_update(urb.buffer, 8, reinterpret_cast<guint8*>(reply.data.data()),
                                 static_cast<gint>(reply.data.size()));
    }
    urb.done = 8 + ((setup.request_type & 0x80) != 0 ? reply.data.size() : setup.length);
    finish(at, reply.outcome == UsbOutcome::kStall  ? -EPIPE
               : reply.outcome == UsbOutcome::kGone ? -ESHUTDOWN
                                                    : 0);
    return true;
  }

  bool run_bulk(std::list<std::unique_ptr<Urb>>::iterator at) {
    Urb& urb = **at;
    UsbOutcome outcome = UsbOutcome::kOk;
    const auto length = static_cast<std::size_t>(urb.head().buffer_length);
    if ((urb.head().endpoint & 0x80) != 0) {
      UsbReply reply = device.bulk_in(length);
      outcome = reply.outcome;
      if (!reply.data.empty()) {
        umockdev_ioctl_data_update(urb.buffer, 0, reinterpret_cast<guint8*>(reply.data.data()),
                                   static_cast<gint>(reply.data.size()));
      }
      urb.done = reply.data.size();
    } else {
      const UsbTaken taken = device.bulk_out(view(urb.buffer).subspan(urb.done, length - urb.done));
      outcome = taken.outcome;
      urb.done += taken.bytes;
    }
    if (outcome == UsbOutcome::kNak) return false;
    finish(at, outcome == UsbOutcome::kStall  ? -EPIPE
               : outcome == UsbOutcome::kGone ? -ESHUTDOWN
                                              : 0);
    return true;
  }

  // One round over all pipes; a transfer that waits blocks those behind it in its own pipe.
  bool run() {
    bool waits[256] = {};
    bool moved = false;
    for (auto at = pending.begin(); at != pending.end();) {
      const auto next = std::next(at);
      const unsigned char pipe = (*at)->head().endpoint;
      if (!waits[pipe]) {
        const bool over =
            (*at)->head().type == USBDEVFS_URB_TYPE_CONTROL ? run_control(at) : run_bulk(at);
        moved = moved || over;
        waits[pipe] = !over;
      }
      at = next;
    }
    return moved;
  }

  void run_pump() {
    std::unique_lock lock(mutex);
    while (!quit) {
      work.wait(lock, [this] { return quit || !pending.empty(); });
      while (!quit && !pending.empty() && run()) {
      }
      if (!quit && !pending.empty()) work.wait_for(lock, kNakPause, [this] { return quit; });
    }
  }

  int submit(UMockdevIoctlClient* client, UMockdevIoctlData* arg) {
    auto urb = std::make_unique<Urb>();
    urb->client = client;
    urb->urb = umockdev_ioctl_data_resolve(arg, 0, sizeof(usbdevfs_urb), nullptr);
    if (urb->urb == nullptr) return -EFAULT;
    urb->address = urb->urb->client_addr;
    const auto length = static_cast<std::size_t>(urb->head().buffer_length);
    std::size_t bytes = length;
    for (const auto& one : pending) bytes += static_cast<std::size_t>(one->head().buffer_length);
    if (max_bytes != 0 && bytes > max_bytes && urb->head().type == USBDEVFS_URB_TYPE_BULK) {
      return -ENOMEM;
    }
    if (length > 0) {
      urb->buffer =
          umockdev_ioctl_data_resolve(urb->urb, offsetof(usbdevfs_urb, buffer), length, nullptr);
      if (urb->buffer == nullptr) return -EFAULT;
    }
    pending.push_back(std::move(urb));
    max_in_flight = std::max(max_in_flight, pending.size());
    work.notify_all();
    return 0;
  }

  int reap(UMockdevIoctlClient* client, UMockdevIoctlData* arg) {
    const auto found = std::find_if(finished.begin(), finished.end(),
                                    [client](const auto& urb) { return urb->client == client; });
    if (found == finished.end()) {
      ++empty_reaps;
      return -EAGAIN;
    }
    UMockdevIoctlData* pointer = umockdev_ioctl_data_resolve(arg, 0, sizeof(void*), nullptr);
    if (pointer == nullptr) return -EFAULT;
    umockdev_ioctl_data_set_ptr(pointer, 0, (*found)->urb);
    g_object_unref(pointer);
    finished.erase(found);
    set_nothing_to_reap();
    return 0;
  }

  int discard(UMockdevIoctlData* arg) {
    gulong address = 0;
    std::memcpy(&address, arg->data, sizeof address);
    for (auto at = pending.begin(); at != pending.end(); ++at) {
      if ((*at)->address != address) continue;
      finish(at, -ENOENT);
      return 0;
    }
    return -EINVAL;
  }

  int handle(UMockdevIoctlClient* client, unsigned long request, UMockdevIoctlData* arg) {
    const auto number = [arg] {
      unsigned value = 0;
      if (UMockdevIoctlData* data = umockdev_ioctl_data_resolve(arg, 0, sizeof value, nullptr)) {
        std::memcpy(&value, data->data, sizeof value);
        g_object_unref(data);
      }
      return value;
    };
    switch (request) {
      case USBDEVFS_GET_CAPABILITIES: {
        std::uint32_t caps = USBDEVFS_CAP_ZERO_PACKET | USBDEVFS_CAP_NO_PACKET_SIZE_LIM |
                             USBDEVFS_CAP_BULK_SCATTER_GATHER | USBDEVFS_CAP_REAP_AFTER_DISCONNECT;
        UMockdevIoctlData* data = umockdev_ioctl_data_resolve(arg, 0, sizeof caps, nullptr);
        umockdev_ioctl_data_update(data, 0, reinterpret_cast<guint8*>(&caps), sizeof caps);
        g_object_unref(data);
        return 0;
      }
      case USBDEVFS_GETDRIVER:
        return -ENODATA;
      case USBDEVFS_DISCONNECT_CLAIM:
        detached = usblp;
        usblp = false;
        return busy ? -EBUSY : 0;
      case USBDEVFS_CLAIMINTERFACE:
        return busy || usblp ? -EBUSY : 0;
      case USBDEVFS_RELEASEINTERFACE:
      case USBDEVFS_IOCTL:
      case USBDEVFS_RESET:
      case USBDEVFS_SETINTERFACE:
      case USBDEVFS_SETCONFIGURATION:
        return 0;
      case USBDEVFS_CLEAR_HALT:
      case USBDEVFS_RESETEP:
        device.clear_halt(static_cast<std::uint8_t>(number()));
        return 0;
      case USBDEVFS_SUBMITURB:
        return submit(client, arg);
      case USBDEVFS_REAPURB:
      case USBDEVFS_REAPURBNDELAY:
        return reap(client, arg);
      case USBDEVFS_DISCARDURB:
        return discard(arg);
      default:
        return -ENOTTY;
    }
  }

  static gboolean on_ioctl(UMockdevIoctlBase*, UMockdevIoctlClient* client, gpointer self) {
    auto& state = *static_cast<State*>(self);
    UMockdevIoctlData* arg = umockdev_ioctl_client_get_arg(client);
    int result = 0;
    {
      const std::lock_guard lock(state.mutex);
      result = state.handle(client, umockdev_ioctl_client_get_request(client), arg);
    }
    umockdev_ioctl_client_complete(client, result < 0 ? -1 : 0, result < 0 ? -result : 0);
    return TRUE;
  }

  // A program that ends takes its transfers along, as the kernel does.
  static void on_vanished(UMockdevIoctlBase*, UMockdevIoctlClient* client, gpointer self) {
    auto& state = *static_cast<State*>(self);
    const std::lock_guard lock(state.mutex);
    const auto its = [client](const std::unique_ptr<Urb>& urb) { return urb->client == client; };
    state.pending.remove_if(its);
    state.finished.remove_if(its);
    state.set_nothing_to_reap();
  }
};

UmockdevBus::UmockdevBus(EmulatedUsbDevice& device) : state_(std::make_unique<State>(device)) {
  state_->testbed = umockdev_testbed_new();
  state_->handler = umockdev_ioctl_base_new();
  g_signal_connect(state_->handler, "handle-ioctl", G_CALLBACK(State::on_ioctl), state_.get());
  g_signal_connect(state_->handler, "client-vanished", G_CALLBACK(State::on_vanished),
                   state_.get());
  GError* error = nullptr;
  if (!umockdev_testbed_attach_ioctl(state_->testbed, kNode, state_->handler, &error)) {
    throw std::runtime_error(error->message);
  }
  // Programs of other users look below this folder too, and make and use sockets there.
  gchar* root = umockdev_testbed_get_root_dir(state_->testbed);
  for (const auto& entry : std::filesystem::recursive_directory_iterator(root)) {
    if (!entry.is_symlink()) chmod(entry.path().c_str(), 0777);
  }
  chmod(root, 0777);
  g_free(root);
  add();
  state_->pump = std::thread([this] { state_->run_pump(); });
}

UmockdevBus::~UmockdevBus() {
  {
    const std::lock_guard lock(state_->mutex);
    state_->quit = true;
  }
  state_->work.notify_all();
  state_->pump.join();
  umockdev_testbed_detach_ioctl(state_->testbed, kNode, nullptr);
  g_object_unref(state_->handler);
  g_object_unref(state_->testbed);
  if (state_->fifo >= 0) close(state_->fifo);
}

std::string UmockdevBus::node() const {
  gchar* root = umockdev_testbed_get_root_dir(state_->testbed);
  const std::string path = std::string(root) + kNode;
  g_free(root);
  return path;
}

void UmockdevBus::add() {
  const std::vector<std::byte> device = state_->device.device_descriptor();
  const std::vector<std::byte> configuration = state_->device.configuration_descriptor();
  const auto u16 = [&](std::size_t at) {
    return static_cast<unsigned>(device[at]) | static_cast<unsigned>(device[at + 1]) << 8;
  };
  const std::string text = fmt::format(
      "P: /devices/usb1/1-1\n"
      "N: bus/usb/001/002\n"
      "E: SUBSYSTEM=usb\nE: DEVTYPE=usb_device\nE: DRIVER=usb\nE: BUSNUM=001\nE: DEVNUM=002\n"
      "E: DEVNAME=/dev/bus/usb/001/002\nE: MAJOR=189\nE: MINOR=1\n"
      "E: ID_USB_INTERFACES=:070102:\n"
      "E: PRODUCT={0:x}/{1:x}/100\nE: TYPE=0/0/0\n"
      "A: busnum=1\\n\nA: devnum=2\\n\nA: bConfigurationValue=1\\n\nA: speed=480\\n\n"
      "A: idVendor={0:04x}\\n\nA: idProduct={1:04x}\\n\n"
      "H: descriptors={2}{3}\n",
      u16(8), u16(10), hex(device), hex(configuration));
  GError* error = nullptr;
  if (!umockdev_testbed_add_from_string(state_->testbed, text.c_str(), &error)) {
    throw std::runtime_error(error->message);
  }
  // By umockdev's own path, not through its preloaded calls: those would look below its root again.
  const std::string path = node();
  unlink(path.c_str());
  if (mkfifo(path.c_str(), 0666) != 0) throw std::runtime_error("no FIFO at " + path);
  chmod(path.c_str(), 0666);
  const std::lock_guard lock(state_->mutex);
  state_->fifo = open(path.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC);
  if (state_->fifo < 0) throw std::runtime_error("cannot open " + path);
  fcntl(state_->fifo, F_SETPIPE_SZ, 4096);
  state_->full = false;
  state_->set_nothing_to_reap();
}

void UmockdevBus::remove() {
  umockdev_testbed_uevent(state_->testbed, kSysPath, "remove");
  umockdev_testbed_remove_device(state_->testbed, kSysPath);
  unlink(node().c_str());
  const std::lock_guard lock(state_->mutex);
  close(state_->fifo);
  state_->fifo = -1;
}

void UmockdevBus::set_busy(bool busy) {
  const std::lock_guard lock(state_->mutex);
  state_->busy = busy;
}

void UmockdevBus::set_usblp(bool bound) {
  const std::lock_guard lock(state_->mutex);
  state_->usblp = bound;
}

void UmockdevBus::set_no_memory(std::size_t most) {
  const std::lock_guard lock(state_->mutex);
  state_->max_bytes = most;
}

bool UmockdevBus::usblp_detached() const {
  const std::lock_guard lock(state_->mutex);
  return state_->detached;
}

int UmockdevBus::empty_reaps() const {
  const std::lock_guard lock(state_->mutex);
  return state_->empty_reaps;
}

std::size_t UmockdevBus::max_in_flight() const {
  const std::lock_guard lock(state_->mutex);
  return state_->max_in_flight;
}

}  // namespace binderjet
