// SPDX-License-Identifier: GPL-3.0-or-later
// usb: opens its printers by libusb; what is sent there is printer_backend's.
#include "transport/usb/usb_backend.h"

#include <utility>

#include "transport/printer/printer_backend.h"
#include "transport/usb/usb_link.h"

namespace binderjet {
namespace {

std::vector<UsbModel> models_of(const BackendOptions& options) {
  std::vector<UsbModel> models = known_usb_models();
  for (const std::string& text : options.usb_models) {
    if (const auto model = parse_usb_model_words(text)) models.push_back(*model);
  }
  return models;
}

Result<std::unique_ptr<PrinterLink>> open_link(const std::string& text,
                                               const std::vector<UsbModel>& models) {
  const Result<UsbUri> uri = parse_usb_uri(text);
  if (!uri) return tl::unexpected(uri.error());
  Result<UsbContext> context = open_usb_context(text);
  if (!context) return tl::unexpected(context.error());
  Result<OpenPrinter> printer = open_printer(context->get(), *uri, text, models);
  if (!printer) return tl::unexpected(printer.error());
  return std::make_unique<UsbLink>(std::move(*context), std::move(*printer));
}

}  // namespace

Result<std::unique_ptr<Backend>> make_usb_backend(const std::string& uri,
                                                  const BackendOptions& options) {
  Result<UsbUri> parsed = parse_usb_uri(uri);
  if (!parsed) return tl::unexpected(parsed.error());
  return make_printer_backend(
      {uri,
       parsed->patience,
       options.state_folder,
       options.stop_asked,
       options.say_wait,
       [models = models_of(options)](const std::string& text) { return open_link(text, models); },
       {}});
}

Result<std::vector<DeviceStatus>> list_usb_devices(const BackendOptions& options) {
  const auto printers = list_printers(models_of(options));
  if (!printers) return tl::unexpected(printers.error());
  std::vector<DeviceStatus> devices;
  for (const SeenPrinter& printer : *printers) {
    devices.push_back({printer.uri, printer.fault.empty() ? printer.description : printer.fault,
                       printer.fault.empty() ? "connected" : "unavailable"});
  }
  return devices;
}

bool wait_for_usb_device(const std::string& uri, const BackendOptions& options, double seconds) {
  const auto parsed = parse_usb_uri(uri);
  if (!parsed) return false;
  return wait_for_printer(*parsed, models_of(options),
                          std::chrono::milliseconds(static_cast<int>(seconds * 1000)),
                          [&] { return options.stop_asked && options.stop_asked(); });
}

}  // namespace binderjet
