// SPDX-License-Identifier: GPL-3.0-or-later
// The backend of every printer that speaks binderjet-1, however it is reached: it takes jobs there
// and keeps a journal of each, so that another process can go on where one was killed.
#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <string>

#include "transport/base/backend.h"
#include "transport/base/result.h"
#include "transport/printer/printer_link.h"

namespace binderjet {

// How a printer is reached, and where its jobs' journals are.
struct PrinterAccess {
  std::string uri;                     // as it was asked for
  std::chrono::milliseconds patience;  // a printer that does nothing for so long is a fault
  std::string journals;                // a folder; its parent exists, or will when `open` returns
  std::function<bool()> stop_asked;    // asked during waits; true ends them with kInterrupted
  SayWait say_wait;

  // Opens the printer of a URI, claimed: nobody else prints to it meanwhile. The URI is the one
  // above, or the one that a link of such a printer gave.
  std::function<Result<std::unique_ptr<PrinterLink>>(const std::string& uri)> open;
  // Why there is nothing to ask about jobs. A printer on a bus may be away and come again with what
  // it holds, so there the journals answer for it, and this is not set.
  std::function<Result<void>()> must_be_there;
};

std::unique_ptr<Backend> make_printer_backend(PrinterAccess access);

// Takes "?patience_s=SECONDS" (0.1 to 86400) off the end of a URI, 30 s if it is not there;
// kBadInput if it is no such number.
Result<std::chrono::milliseconds> take_patience(std::string& uri);

}  // namespace binderjet
