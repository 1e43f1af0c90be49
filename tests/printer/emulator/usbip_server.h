// SPDX-License-Identifier: GPL-3.0-or-later
// Front end for a real kernel: the emulated device as a USB/IP export, for `usbip attach`.
#pragma once

#include <atomic>

#include "transport/emulator/emulated_usb_device.h"

namespace binderjet {

// Serves one host after the other on 127.0.0.1:`port` until `stop`. False if the port is taken.
bool serve_usbip(EmulatedUsbDevice& device, int port, const std::atomic<bool>& stop);

}  // namespace binderjet
