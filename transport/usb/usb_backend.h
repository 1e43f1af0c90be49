// SPDX-License-Identifier: GPL-3.0-or-later
// Printers on the bus: the backend that sends to one, and which ones there are.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "transport/base/backend.h"
#include "transport/base/result.h"

namespace binderjet {

// A printer that speaks binderjet-1 (PROTOCOL.md). A URI that is none is kBadInput.
Result<std::unique_ptr<Backend>> make_usb_backend(const std::string& uri,
                                                  const BackendOptions& options);

// The USB printers that are plugged in and known.
Result<std::vector<DeviceStatus>> list_usb_devices(const BackendOptions& options);
// Waits until the printer of a usb: URI is plugged in; false when the time is over or a stop is
// asked for.
bool wait_for_usb_device(const std::string& uri, const BackendOptions& options, double seconds);

}  // namespace binderjet
