// SPDX-License-Identifier: GPL-3.0-or-later
// Plugs an emulated printer into the socket of its folder.
#pragma once

#include <functional>

#include "transport/emulator/printer_emulator.h"
#include "transport/emulator/printer_socket.h"

namespace binderjet {

// Serves hosts, one at a time, until `stop`, which is asked at least ten times a second; throws
// what the printer's watcher throws. A host that comes after a fault finds it mended (mend()).
// Calls the printer from this thread only.
void serve_on_socket(PrinterEmulator& printer, const PrinterSocket& socket,
                     const std::function<bool()>& stop);

}  // namespace binderjet
