// SPDX-License-Identifier: GPL-3.0-or-later
// Queues transfers per endpoint, offers them to the device and sends its answers.
#include "tests/printer/emulator/usbredir_port.h"

#include <algorithm>
#include <utility>

#include "tests/printer/emulator/usbredir_descriptors.h"

namespace binderjet {
namespace {

constexpr std::uint8_t kIn = 0x80;
constexpr std::uint8_t kTypeMask = 0x60;  // of a request: 0 is standard
constexpr std::uint8_t kRecipientMask = 0x1f;
constexpr std::uint8_t kToEndpoint = 2;
constexpr std::uint8_t kGetStatus = 0;
constexpr std::uint8_t kClearFeature = 1;
constexpr std::uint8_t kGetDescriptor = 6;
constexpr std::uint16_t kEndpointHalt = 0;

std::uint8_t status_of(UsbOutcome outcome) {
  return outcome == UsbOutcome::kStall ? usb_redir_stall : usb_redir_success;
}

}  // namespace

void UsbredirPort::announce() {
  const Descriptors what = read_descriptors(device_);
  usb_redir_interface_info_header interfaces = what.interfaces;
  usb_redir_ep_info_header pipes = what.endpoints;
  usb_redir_device_connect_header connect = what.connect;
  usbredirparser_send_interface_info(parser_.get(), &interfaces);
  usbredirparser_send_ep_info(parser_.get(), &pipes);
  usbredirparser_send_device_connect(parser_.get(), &connect);
}

void UsbredirPort::queue_control(std::uint64_t id, const usb_redir_control_packet_header& head,
                                 std::vector<std::byte> out) {
  Transfer transfer;
  transfer.id = id;
  transfer.length = head.length;
  transfer.out = std::move(out);
  transfer.control = head;
  endpoints_[0].queue.push_back(std::move(transfer));
}

void UsbredirPort::queue_bulk(std::uint64_t id, const usb_redir_bulk_packet_header& head,
                              std::vector<std::byte> out) {
  Transfer transfer;
  transfer.id = id;
  transfer.length = head.length | static_cast<std::uint32_t>(head.length_high) << 16;
  transfer.out = std::move(out);
  transfer.bulk = head;
  endpoints_[head.endpoint].queue.push_back(std::move(transfer));
}

void UsbredirPort::cancel(std::uint64_t id) {
  for (auto& [address, endpoint] : endpoints_) {
    const auto at = std::find_if(endpoint.queue.begin(), endpoint.queue.end(),
                                 [id](const Transfer& transfer) { return transfer.id == id; });
    if (at != endpoint.queue.end()) {
      answer(address, *at, usb_redir_cancelled, {});
      endpoint.queue.erase(at);
      return;
    }
  }
  // Its answer and the cancel have crossed; the peer knows such answers by their id.
}

// Halts end with a reset and with a new configuration (USB 2.0, 9.4.5).
void UsbredirPort::reset() {
  for (auto& [address, endpoint] : endpoints_) {
    if (std::exchange(endpoint.halted, false)) device_.clear_halt(address);
  }
}

void UsbredirPort::set_configuration(std::uint64_t id, std::uint8_t value) {
  const std::uint8_t only = configuration_value(device_);
  usb_redir_configuration_status_header status{};
  status.status = value == 0 || value == only ? usb_redir_success : usb_redir_stall;
  if (status.status == usb_redir_success) {
    configuration_ = value;
    reset();
  }
  status.configuration = configuration_;
  usbredirparser_send_configuration_status(parser_.get(), id, &status);
}

void UsbredirPort::set_alternate(std::uint64_t id, std::uint8_t interface, std::uint8_t alternate) {
  usb_redir_alt_setting_status_header status{};
  status.status = alternate == 0 ? usb_redir_success : usb_redir_stall;
  status.interface = interface;
  if (alternate == 0) reset();
  usbredirparser_send_alt_setting_status(parser_.get(), id, &status);
}

bool UsbredirPort::attend() {
  bool moved = false;
  // An answer on one pipe may be what another waits for: a layer taken is a layer acknowledged.
  for (bool again = true; again && !gone_;) {
    again = false;
    for (auto& [address, endpoint] : endpoints_) {
      if (!gone_ && attend(address, endpoint)) again = true;
    }
    moved = moved || again;
  }
  return moved;
}

bool UsbredirPort::waiting() const {
  return !gone_ && std::any_of(endpoints_.begin(), endpoints_.end(), [](const auto& each) {
    return !each.second.halted && !each.second.queue.empty();
  });
}

bool UsbredirPort::attend(std::uint8_t address, Endpoint& endpoint) {
  bool moved = false;
  while (!endpoint.halted && !endpoint.queue.empty()) {
    Transfer& transfer = endpoint.queue.front();
    const std::size_t before = transfer.done;
    const UsbOutcome outcome = address == 0 ? do_control(transfer) : do_bulk(address, transfer);
    if (outcome == UsbOutcome::kGone) {
      part();
      return true;
    }
    if (outcome == UsbOutcome::kNak) return moved || transfer.done != before;
    // A halted pipe keeps what is queued behind the stall, until the host cancels or clears it.
    endpoint.halted = address != 0 && outcome == UsbOutcome::kStall;
    endpoint.queue.pop_front();
    moved = true;
  }
  return moved;
}

UsbOutcome UsbredirPort::do_control(Transfer& transfer) {
  const usb_redir_control_packet_header& head = transfer.control;
  const ControlSetup setup{head.requesttype, head.request, head.value, head.index, head.length};
  UsbReply reply = (setup.request_type & kTypeMask) == 0 ? standard_request(setup)
                                                         : device_.control(setup, transfer.out);
  if (reply.outcome == UsbOutcome::kNak || reply.outcome == UsbOutcome::kGone) return reply.outcome;
  if (reply.data.size() > head.length) reply.data.resize(head.length);
  transfer.done = transfer.out.size();
  answer(0, transfer, status_of(reply.outcome), std::move(reply.data));
  return reply.outcome;
}

// Address, configuration and interface have messages of their own and never come here.
UsbReply UsbredirPort::standard_request(const ControlSetup& setup) {
  const auto address = static_cast<std::uint8_t>(setup.index);
  const bool to_endpoint = (setup.request_type & kRecipientMask) == kToEndpoint;
  if (setup.request == kGetDescriptor) return get_descriptor(device_, setup.value);
  if (setup.request == kGetStatus) {
    const bool halted = to_endpoint && endpoints_[address].halted;
    return {UsbOutcome::kOk, {std::byte{halted}, std::byte{0}}};
  }
  if (setup.request == kClearFeature && to_endpoint && setup.value == kEndpointHalt) {
    endpoints_[address].halted = false;
    device_.clear_halt(address);
    return {};
  }
  return {UsbOutcome::kStall, {}};
}

UsbOutcome UsbredirPort::do_bulk(std::uint8_t address, Transfer& transfer) {
  if ((address & kIn) != 0) {
    UsbReply reply = device_.bulk_in(transfer.length);
    if (reply.outcome == UsbOutcome::kNak || reply.outcome == UsbOutcome::kGone) {
      return reply.outcome;
    }
    answer(address, transfer, status_of(reply.outcome), std::move(reply.data));
    return reply.outcome;
  }
  const UsbTaken taken =
      device_.bulk_out(std::span<const std::byte>(transfer.out).subspan(transfer.done));
  transfer.done += taken.bytes;
  if (taken.outcome == UsbOutcome::kOk || taken.outcome == UsbOutcome::kStall) {
    answer(address, transfer, status_of(taken.outcome), {});
  }
  return taken.outcome;
}

void UsbredirPort::answer(std::uint8_t address, Transfer& transfer, std::uint8_t status,
                          std::vector<std::byte> data) {
  auto* bytes = reinterpret_cast<std::uint8_t*>(data.data());
  const int size = static_cast<int>(data.size());
  if (address == 0) {
    const bool in = (transfer.control.requesttype & kIn) != 0;
    transfer.control.status = status;
    transfer.control.length = static_cast<std::uint16_t>(in ? data.size() : transfer.done);
    usbredirparser_send_control_packet(parser_.get(), transfer.id, &transfer.control,
                                       size > 0 ? bytes : nullptr, size);
    return;
  }
  const std::size_t moved = (address & kIn) != 0 ? data.size() : transfer.done;
  transfer.bulk.status = status;
  transfer.bulk.length = static_cast<std::uint16_t>(moved & 0xffff);
  transfer.bulk.length_high = static_cast<std::uint16_t>(moved >> 16);
  usbredirparser_send_bulk_packet(parser_.get(), transfer.id, &transfer.bulk,
                                  size > 0 ? bytes : nullptr, size);
}

// The peer ends what is in flight itself: transfers to a device that left have no answer.
void UsbredirPort::part() {
  gone_ = true;
  for (auto& [address, endpoint] : endpoints_) endpoint.queue.clear();
  usbredirparser_send_device_disconnect(parser_.get());
  awaits_ack_ =
      usbredirparser_peer_has_cap(parser_.get(), usb_redir_cap_device_disconnect_ack) != 0;
}

}  // namespace binderjet
