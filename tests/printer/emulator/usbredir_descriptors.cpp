// SPDX-License-Identifier: GPL-3.0-or-later
// Walks the descriptors of a device (USB 2.0, 9.6).
#include "tests/printer/emulator/usbredir_descriptors.h"

#include <algorithm>
#include <iterator>
#include <utility>

namespace binderjet {
namespace {

constexpr std::uint8_t kDevice = 1;
constexpr std::uint8_t kConfiguration = 2;
constexpr std::uint8_t kString = 3;
constexpr std::uint8_t kInterface = 4;
constexpr std::uint8_t kEndpoint = 5;
constexpr std::size_t kEndpoints = 32;  // 16 OUT, then 16 IN

std::uint8_t byte_at(const std::vector<std::byte>& bytes, std::size_t at) {
  return at < bytes.size() ? std::to_integer<std::uint8_t>(bytes[at]) : std::uint8_t{0};
}

std::uint16_t word_at(const std::vector<std::byte>& bytes, std::size_t at) {
  return static_cast<std::uint16_t>(byte_at(bytes, at) | byte_at(bytes, at + 1) << 8);
}

void add_interface(const std::vector<std::byte>& bytes, std::size_t at,
                   usb_redir_interface_info_header& all) {
  if (byte_at(bytes, at + 3) != 0 || all.interface_count == std::size(all.interface)) return;
  const std::uint32_t next = all.interface_count++;
  all.interface[next] = byte_at(bytes, at + 2);
  all.interface_class[next] = byte_at(bytes, at + 5);
  all.interface_subclass[next] = byte_at(bytes, at + 6);
  all.interface_protocol[next] = byte_at(bytes, at + 7);
}

void add_endpoint(const std::vector<std::byte>& bytes, std::size_t at, std::uint8_t interface,
                  usb_redir_ep_info_header& all) {
  const std::uint8_t address = byte_at(bytes, at + 2);
  const std::size_t slot = ((address & 0x80U) >> 3) | (address & 0x0fU);
  all.type[slot] = byte_at(bytes, at + 3) & 3;
  all.interval[slot] = byte_at(bytes, at + 6);
  all.interface[slot] = interface;
  all.max_packet_size[slot] = word_at(bytes, at + 4);
}

}  // namespace

Descriptors read_descriptors(const EmulatedUsbDevice& device) {
  Descriptors result;
  const std::vector<std::byte> head = device.device_descriptor();
  result.connect.speed = usb_redir_speed_high;
  result.connect.device_class = byte_at(head, 4);
  result.connect.device_subclass = byte_at(head, 5);
  result.connect.device_protocol = byte_at(head, 6);
  result.connect.vendor_id = word_at(head, 8);
  result.connect.product_id = word_at(head, 10);
  result.connect.device_version_bcd = word_at(head, 12);

  for (std::size_t slot = 0; slot < kEndpoints; ++slot) {
    result.endpoints.type[slot] = slot % 16 == 0 ? std::uint8_t{usb_redir_type_control}
                                                 : std::uint8_t{usb_redir_type_invalid};
    result.endpoints.max_packet_size[slot] = slot % 16 == 0 ? byte_at(head, 7) : std::uint8_t{0};
  }
  const std::vector<std::byte> body = device.configuration_descriptor();
  std::uint8_t interface = 0;
  // A descriptor shorter than its own head would stop the walk.
  for (std::size_t at = 0; at + 2 <= body.size();
       at += std::max<std::size_t>(2, byte_at(body, at))) {
    if (byte_at(body, at + 1) == kInterface) {
      interface = byte_at(body, at + 2);
      add_interface(body, at, result.interfaces);
    } else if (byte_at(body, at + 1) == kEndpoint) {
      add_endpoint(body, at, interface, result.endpoints);
    }
  }
  return result;
}

UsbReply get_descriptor(const EmulatedUsbDevice& device, std::uint16_t kind_and_index) {
  const int index = kind_and_index & 0xff;
  std::vector<std::byte> found;
  switch (kind_and_index >> 8) {
    case kDevice:
      found = device.device_descriptor();
      break;
    case kConfiguration:
      if (index == 0) found = device.configuration_descriptor();
      break;
    case kString:
      found = device.string_descriptor(index);
      break;
    default:
      break;
  }
  if (found.empty()) return {UsbOutcome::kStall, {}};
  return {UsbOutcome::kOk, std::move(found)};
}

std::uint8_t configuration_value(const EmulatedUsbDevice& device) {
  return byte_at(device.configuration_descriptor(), 5);
}

}  // namespace binderjet
