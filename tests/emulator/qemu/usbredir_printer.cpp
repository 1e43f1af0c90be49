// SPDX-License-Identifier: GPL-3.0-or-later
// The emulated printer on a usb-redir socket, alone: usbredir_printer --usbredir PATH.
#include <sys/signalfd.h>

#include <csignal>
#include <cstdio>
#include <string_view>

#include "tests/emulator/printer_emulator.h"
#include "tests/emulator/usbredir_serve.h"

int main(int count, char** words) {
  if (count != 3 || std::string_view(words[1]) != "--usbredir") {
    std::fputs("usbredir_printer --usbredir PATH\n", stderr);
    return 2;
  }
  sigset_t ends;
  sigemptyset(&ends);
  sigaddset(&ends, SIGTERM);
  sigaddset(&ends, SIGINT);
  sigprocmask(SIG_BLOCK, &ends, nullptr);

  binderjet::PrinterEmulator printer;
  const auto result = binderjet::serve_usbredir(printer, words[2], signalfd(-1, &ends, 0));
  std::printf("%llu bytes taken, %d layers acknowledged, %d sent again\n",
              static_cast<unsigned long long>(printer.bytes_taken()), printer.acknowledged(),
              printer.sent_again());
  if (result.end != binderjet::UsbredirEnd::kFailed) return 0;
  std::fprintf(stderr, "%s\n", result.why.c_str());
  return 4;
}
