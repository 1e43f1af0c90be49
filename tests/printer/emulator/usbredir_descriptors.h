// SPDX-License-Identifier: GPL-3.0-or-later
// What a device's descriptors say, in the words of the usb-redir protocol.
#pragma once

#include <usbredirproto.h>

#include <cstdint>

#include "transport/emulator/emulated_usb_device.h"

namespace binderjet {

struct Descriptors {
  usb_redir_device_connect_header connect{};
  usb_redir_interface_info_header interfaces{};
  usb_redir_ep_info_header endpoints{};
};

// The device is a high-speed one with at most 32 interfaces.
Descriptors read_descriptors(const EmulatedUsbDevice& device);

// The answer to GET_DESCRIPTOR; kStall for a kind the device does not have.
UsbReply get_descriptor(const EmulatedUsbDevice& device, std::uint16_t kind_and_index);

// The number SET_CONFIGURATION chooses the only configuration by.
std::uint8_t configuration_value(const EmulatedUsbDevice& device);

}  // namespace binderjet
