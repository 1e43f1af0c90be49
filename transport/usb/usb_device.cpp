// SPDX-License-Identifier: GPL-3.0-or-later
// Looking through the bus: which device is meant, which of its interfaces prints, who may open it.
#include "transport/usb/usb_device.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include "transport/printer/printer_backend.h"

namespace binderjet {
namespace {

constexpr unsigned kControlTimeoutMs = 300;

struct ListCloser {
  void operator()(libusb_device** list) const { libusb_free_device_list(list, 1); }
};
using DeviceList = std::unique_ptr<libusb_device*, ListCloser>;

// The printer-class interface with two pipes (07/01/02).
std::optional<UsbInterface> printer_interface(libusb_device* device) {
  libusb_config_descriptor* raw = nullptr;
  if (libusb_get_active_config_descriptor(device, &raw) != 0 &&
      libusb_get_config_descriptor(device, 0, &raw) != 0) {
    return std::nullopt;
  }
  const std::unique_ptr<libusb_config_descriptor, void (*)(libusb_config_descriptor*)> config(
      raw, libusb_free_config_descriptor);
  for (int i = 0; i < config->bNumInterfaces; ++i) {
    for (int a = 0; a < config->interface[i].num_altsetting; ++a) {
      const libusb_interface_descriptor& one = config->interface[i].altsetting[a];
      if (one.bInterfaceClass != LIBUSB_CLASS_PRINTER || one.bInterfaceSubClass != 1 ||
          one.bInterfaceProtocol != 2) {
        continue;
      }
      UsbInterface found;
      found.number = one.bInterfaceNumber;
      found.alternate = one.bAlternateSetting;
      for (int e = 0; e < one.bNumEndpoints; ++e) {
        const libusb_endpoint_descriptor& end = one.endpoint[e];
        if ((end.bmAttributes & LIBUSB_TRANSFER_TYPE_MASK) != LIBUSB_TRANSFER_TYPE_BULK) continue;
        if ((end.bEndpointAddress & LIBUSB_ENDPOINT_IN) != 0) {
          found.in = end.bEndpointAddress;
          found.packet_bytes = std::max(8, end.wMaxPacketSize & 0x7ff);
        } else {
          found.out = end.bEndpointAddress;
        }
      }
      if (found.in != 0 && found.out != 0) return found;
    }
  }
  return std::nullopt;
}

std::string serial_of(libusb_device_handle* handle, const libusb_device_descriptor& descriptor) {
  std::array<unsigned char, 256> text{};
  if (descriptor.iSerialNumber == 0) return "";
  const int length = libusb_get_string_descriptor_ascii(handle, descriptor.iSerialNumber,
                                                        text.data(), static_cast<int>(text.size()));
  std::string serial;
  for (int i = 0; i < length; ++i) {
    const unsigned char c = text[static_cast<std::size_t>(i)];
    // What would end a URI or a command line's word has no place in one.
    serial += c > 0x20 && c < 0x7f && c != '?' && c != '/' && c != '#' ? static_cast<char>(c) : '_';
  }
  return serial;
}

std::string uri_of(const libusb_device_descriptor& descriptor, const std::string& serial) {
  return fmt::format("usb://{:04x}:{:04x}{}{}", descriptor.idVendor, descriptor.idProduct,
                     serial.empty() ? "" : "/", serial);
}

std::string read_device_id(libusb_device_handle* handle, const UsbInterface& interface,
                           const UsbQuirks& quirks) {
  if (quirks.no_device_id) return "";
  std::array<unsigned char, 1024> answer{};
  const int length = libusb_control_transfer(
      handle, 0xa1, 0, 0, static_cast<std::uint16_t>(interface.number << 8 | interface.alternate),
      answer.data(), static_cast<std::uint16_t>(answer.size()), kControlTimeoutMs);
  // It is optional: a printer that stalls it prints all the same.
  if (length <= 0) return "";
  return device_id_text(
      {reinterpret_cast<const char*>(answer.data()), static_cast<std::size_t>(length)}, quirks);
}

bool is_model(const UsbModel& model, const libusb_device_descriptor& descriptor) {
  return model.vendor == descriptor.idVendor && model.product == descriptor.idProduct;
}

// The model that the URI may mean by this device.
std::optional<UsbModel> meant(const UsbUri& uri, const std::vector<UsbModel>& models,
                              const libusb_device_descriptor& descriptor) {
  if (!uri.any && !is_model(uri.model, descriptor)) return std::nullopt;
  const auto known = std::find_if(models.begin(), models.end(), [&](const UsbModel& model) {
    return is_model(model, descriptor);
  });
  if (known != models.end()) return *known;
  if (uri.any) return std::nullopt;
  return uri.model;
}

struct Match {
  libusb_device* device = nullptr;
  libusb_device_descriptor descriptor{};
  UsbInterface interface;
  UsbModel model;
};

std::vector<Match> matches(libusb_device** list, ssize_t count, const UsbUri& uri,
                           const std::vector<UsbModel>& models) {
  std::vector<Match> found;
  for (ssize_t i = 0; i < count; ++i) {
    Match match;
    match.device = list[i];
    if (libusb_get_device_descriptor(list[i], &match.descriptor) != 0) continue;
    const std::optional<UsbModel> model = meant(uri, models, match.descriptor);
    if (!model) continue;
    const std::optional<UsbInterface> interface = printer_interface(list[i]);
    if (!interface) continue;
    match.model = *model;
    match.interface = *interface;
    found.push_back(match);
  }
  return found;
}

Result<OpenPrinter> open_match(const Match& match, const UsbUri& uri) {
  const std::string plain = uri_of(match.descriptor, "");
  libusb_device_handle* raw = nullptr;
  if (const int error = libusb_open(match.device, &raw); error != 0) {
    return tl::unexpected(usb_failure(error, plain, "cannot open the printer"));
  }
  OpenPrinter printer{UsbHandle(raw), match.interface, match.model.quirks, "", ""};
  const std::string serial = serial_of(raw, match.descriptor);
  printer.uri = uri_of(match.descriptor, serial);
  if (!uri.serial.empty() && uri.serial != serial) {
    return tl::unexpected(
        Failure{FailureKind::kDevice, plain, fmt::format("has the serial number {}", serial)});
  }
  return printer;
}

Result<void> claim(OpenPrinter& printer) {
  libusb_device_handle* handle = printer.handle.get();
  // usblp holds every printer-class device; it gets it back when we close. Where the system has no
  // such thing there is nothing to detach.
  static_cast<void>(libusb_set_auto_detach_kernel_driver(handle, 1));
  if (const int error = libusb_claim_interface(handle, printer.interface.number); error != 0) {
    return tl::unexpected(usb_failure(error, printer.uri, "cannot claim the printer"));
  }
  if (printer.interface.alternate != 0) {
    const int error = libusb_set_interface_alt_setting(handle, printer.interface.number,
                                                       printer.interface.alternate);
    if (error != 0) return tl::unexpected(usb_failure(error, printer.uri, "cannot set it up"));
  }
  printer.device_id = read_device_id(handle, printer.interface, printer.quirks);
  return {};
}

}  // namespace

Result<UsbUri> parse_usb_uri(const std::string& uri) {
  const auto bad = [&uri](const char* what) {
    return tl::unexpected(Failure{FailureKind::kBadInput, uri,
                                  fmt::format("{}; use usb: or usb://VID:PID/SERIAL", what)});
  };
  if (!uri.starts_with("usb:")) return bad("not a USB printer");
  std::string plain = uri;
  const auto patience = take_patience(plain);
  if (!patience) return tl::unexpected(patience.error());
  UsbUri parsed;
  parsed.patience = *patience;
  std::string_view rest = std::string_view(plain).substr(4);
  if (rest.find('?') != std::string_view::npos)
    return bad("the only option is ?patience_s=SECONDS");
  if (rest.empty() || rest == "//") return parsed;
  if (!rest.starts_with("//")) return bad("not a USB printer");
  rest.remove_prefix(2);
  const std::size_t slash = std::min(rest.find('/'), rest.size());
  const std::optional<UsbModel> model = parse_usb_model(rest.substr(0, slash));
  if (!model) return bad("no vendor and product id in hexadecimal");
  parsed.any = false;
  parsed.model = *model;
  if (slash < rest.size()) parsed.serial = rest.substr(slash + 1);
  return parsed;
}

Result<UsbContext> open_usb_context(const std::string& uri) {
  libusb_context* context = nullptr;
  if (const int error = libusb_init(&context); error != 0) {
    return tl::unexpected(usb_failure(error, uri, "cannot use USB"));
  }
  return UsbContext(context);
}

Result<OpenPrinter> open_printer(libusb_context* context, const UsbUri& uri,
                                 const std::string& text, const std::vector<UsbModel>& models) {
  libusb_device** raw = nullptr;
  const ssize_t count = libusb_get_device_list(context, &raw);
  if (count < 0) {
    return tl::unexpected(usb_failure(static_cast<int>(count), text, "cannot look for printers"));
  }
  const DeviceList list(raw);
  std::vector<OpenPrinter> opened;
  std::optional<Failure> fault;
  for (const Match& match : matches(raw, count, uri, models)) {
    Result<OpenPrinter> printer = open_match(match, uri);
    if (printer) {
      opened.push_back(std::move(*printer));
    } else {
      fault = printer.error();
    }
  }
  if (opened.empty()) {
    if (fault) return tl::unexpected(*fault);
    return tl::unexpected(Failure{
        FailureKind::kDevice, text,
        "no such printer is connected; is it switched on? `binderjet devices` lists what is"});
  }
  if (opened.size() > 1) {
    std::string names;
    for (const OpenPrinter& one : opened) names += (names.empty() ? "" : ", ") + one.uri;
    return tl::unexpected(
        Failure{FailureKind::kDevice, text, "several printers are connected; name one: " + names});
  }
  if (auto done = claim(opened.front()); !done) return tl::unexpected(done.error());
  return std::move(opened.front());
}

Result<std::vector<SeenPrinter>> list_printers(const std::vector<UsbModel>& models) {
  const Result<UsbContext> context = open_usb_context("usb:");
  if (!context) return tl::unexpected(context.error());
  libusb_device** raw = nullptr;
  const ssize_t count = libusb_get_device_list(context->get(), &raw);
  if (count < 0) {
    return tl::unexpected(usb_failure(static_cast<int>(count), "usb:", "cannot look for printers"));
  }
  const DeviceList list(raw);
  std::vector<SeenPrinter> seen;
  for (const Match& match : matches(raw, count, UsbUri{}, models)) {
    Result<OpenPrinter> printer = open_match(match, UsbUri{});
    if (!printer) {
      seen.push_back({uri_of(match.descriptor, ""), "", printer.error().what});
      continue;
    }
    std::array<unsigned char, 256> text{};
    const int length =
        libusb_get_string_descriptor_ascii(printer->handle.get(), match.descriptor.iProduct,
                                           text.data(), static_cast<int>(text.size()));
    std::string name(text.begin(), text.begin() + std::max(0, length));
    seen.push_back({printer->uri, name.empty() ? "printer" : name, ""});
  }
  return seen;
}

bool wait_for_printer(const UsbUri& uri, const std::vector<UsbModel>& models,
                      std::chrono::milliseconds time, const std::function<bool()>& stop) {
  const Result<UsbContext> context = open_usb_context("usb:");
  if (!context) return false;
  libusb_context* usb = context->get();
  const auto is_there = [&] {
    libusb_device** raw = nullptr;
    const ssize_t count = libusb_get_device_list(usb, &raw);
    if (count < 0) return false;
    const DeviceList list(raw);
    return !matches(raw, count, uri, models).empty();
  };
  // The event only ends a wait: what arrived is looked at in the list, so no event can be missed.
  libusb_hotplug_callback_handle registered = 0;
  if (libusb_has_capability(LIBUSB_CAP_HAS_HOTPLUG) != 0) {
    libusb_hotplug_register_callback(
        usb, LIBUSB_HOTPLUG_EVENT_DEVICE_ARRIVED, 0, LIBUSB_HOTPLUG_MATCH_ANY,
        LIBUSB_HOTPLUG_MATCH_ANY, LIBUSB_HOTPLUG_MATCH_ANY,
        [](libusb_context*, libusb_device*, libusb_hotplug_event, void*) { return 0; }, nullptr,
        &registered);
  }
  const auto end = std::chrono::steady_clock::now() + time;
  while (!is_there()) {
    if (stop() || std::chrono::steady_clock::now() >= end) return false;
    timeval slice{0, 200'000};
    libusb_handle_events_timeout_completed(usb, &slice, nullptr);
  }
  return true;
}

Failure usb_failure(int error, const std::string& uri, const std::string& doing) {
  const char* why = libusb_strerror(error);
  switch (error) {
    case LIBUSB_ERROR_ACCESS:
      why =
          "this user may not; join its group (sudo usermod -aG lp $USER, then log in again) or "
          "install udev/60-binderjet.rules";
      break;
    case LIBUSB_ERROR_BUSY:
      why =
          "another program uses it; let that one finish, or stop it (a CUPS queue, a virtual "
          "machine)";
      break;
    case LIBUSB_ERROR_NO_DEVICE:
      why = "it was unplugged or switched off; plug it in";
      break;
    case LIBUSB_ERROR_NO_MEM:
      why = "no memory for USB; raise /sys/module/usbcore/parameters/usbfs_memory_mb";
      break;
    default:
      break;
  }
  return {FailureKind::kDevice, uri, fmt::format("{}: {}", doing, why)};
}

}  // namespace binderjet
