// SPDX-License-Identifier: GPL-3.0-or-later
// Finding a printer on the bus by its URI and opening it, with words that name the fix where it
// cannot be opened.
#pragma once

#include <libusb.h>

#include <chrono>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "transport/base/result.h"
#include "transport/usb/usb_quirks.h"

namespace binderjet {

// usb: or usb://VID:PID or usb://VID:PID/SERIAL, each with ?patience_s=N.
struct UsbUri {
  bool any = true;  // usb:
  UsbModel model;   // where not any
  std::string serial;
  std::chrono::milliseconds patience{30000};  // a printer that does nothing for so long is a fault
};
Result<UsbUri> parse_usb_uri(const std::string& uri);

struct UsbContextCloser {
  void operator()(libusb_context* context) const { libusb_exit(context); }
};
using UsbContext = std::unique_ptr<libusb_context, UsbContextCloser>;
Result<UsbContext> open_usb_context(const std::string& uri);

struct UsbHandleCloser {
  void operator()(libusb_device_handle* handle) const { libusb_close(handle); }
};
using UsbHandle = std::unique_ptr<libusb_device_handle, UsbHandleCloser>;

struct UsbInterface {
  int number = 0;
  int alternate = 0;
  unsigned char out = 0;
  unsigned char in = 0;
  int packet_bytes = 512;  // of the IN pipe
};

// A printer that was opened, its interface claimed: nobody else prints to it meanwhile.
struct OpenPrinter {
  UsbHandle handle;
  UsbInterface interface;
  UsbQuirks quirks;
  std::string uri;        // usb://VID:PID/SERIAL
  std::string device_id;  // IEEE 1284; may be empty
};

// `models` are those that usb: may mean; a URI that names its device needs none.
Result<OpenPrinter> open_printer(libusb_context* context, const UsbUri& uri,
                                 const std::string& text, const std::vector<UsbModel>& models);

struct SeenPrinter {
  std::string uri;
  std::string description;
  std::string fault;  // why it cannot be opened, or empty
};
// The printers of these models that are plugged in; each is opened for a moment and not claimed.
Result<std::vector<SeenPrinter>> list_printers(const std::vector<UsbModel>& models);

// Waits until such a printer is plugged in: by hotplug events where the system has them. False
// when the time is over or `stop` says so.
bool wait_for_printer(const UsbUri& uri, const std::vector<UsbModel>& models,
                      std::chrono::milliseconds time, const std::function<bool()>& stop);

// A libusb error as a Failure: what is wrong and what to do.
Failure usb_failure(int error, const std::string& uri, const std::string& doing);

}  // namespace binderjet
