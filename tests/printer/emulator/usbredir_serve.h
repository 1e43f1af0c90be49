// SPDX-License-Identifier: GPL-3.0-or-later
// Plugs an emulated device into a QEMU that listens on a UNIX socket for usb-redir.
#pragma once

#include <string>

#include "transport/emulator/emulated_usb_device.h"

namespace binderjet {

enum class UsbredirEnd {
  kStopped,     // `stop_fd` became readable
  kGone,        // the device said kGone; call again to plug it in again
  kPeerClosed,  // QEMU ended or closed the socket
  kFailed,      // no socket, or a peer that does not speak the protocol
};

struct UsbredirResult {
  UsbredirEnd end = UsbredirEnd::kStopped;
  std::string why;  // of kFailed
};

// Connects to `socket_path`, which may appear up to 10 s later, as after
//   qemu ... -chardev socket,id=c,path=PATH,server=on,wait=off -device usb-redir,chardev=c
// and serves `device` until one of the ends above. `stop_fd` is a signalfd or eventfd, or -1.
// Calls the device from this thread only.
UsbredirResult serve_usbredir(EmulatedUsbDevice& device, const std::string& socket_path,
                              int stop_fd);

// The same on a connected socket, which it closes.
UsbredirResult serve_usbredir_on(EmulatedUsbDevice& device, int socket, int stop_fd);

}  // namespace binderjet
