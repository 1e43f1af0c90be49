// SPDX-License-Identifier: GPL-3.0-or-later
// binderjet-emulator: a printer to plug in without one, which prints into slice stacks.
#include <fmt/core.h>
#include <sys/eventfd.h>

#include <CLI/CLI.hpp>
#include <atomic>
#include <csignal>
#include <exception>
#include <string>
#include <thread>

#include "driver/emulator/printed_volume.h"
#include "tests/printer/emulator/usbip_server.h"
#include "tests/printer/emulator/usbredir_serve.h"
#include "transport/emulator/printer_emulator.h"

namespace {

std::atomic<bool> stop{false};
const int stop_event = eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK);
static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler writes it");

void ask_to_stop(int) {
  stop = true;
  eventfd_write(stop_event, 1);
}

// Says on stderr why it could not serve.
bool serve(binderjet::PrinterEmulator& printer, const std::string& usbredir, int port) {
  using namespace binderjet;
  if (usbredir.empty()) {
    if (serve_usbip(printer, port, stop)) return true;
    fmt::print(stderr, "binderjet-emulator: port {} is taken\n", port);
    return false;
  }
  const UsbredirResult result = serve_usbredir(printer, usbredir, stop_event);
  if (result.end != UsbredirEnd::kFailed) return true;
  fmt::print(stderr, "binderjet-emulator: {}\n", result.why);
  return false;
}

}  // namespace

int main(int argc, char** argv) {
  using namespace binderjet;
  CLI::App program{
      "An emulated powder-binder printer on USB, for binderjet's tests and for trying it",
      "binderjet-emulator"};
  int port = 3240;
  int layer_ms = 0;
  std::string usbredir;
  std::string out;
  std::vector<std::string> faults;
  EmulatorOptions options;
  program
      .add_option("--usbip", port,
                  "serve USB/IP on this port of 127.0.0.1; then, on Linux: modprobe vhci-hcd; "
                  "usbip attach -r 127.0.0.1 -b 1-1")
      ->capture_default_str();
  program.add_option("--usbredir", usbredir,
                     "instead plug into the QEMU that has -chardev "
                     "socket,id=c,path=PATH,server=on,wait=off -device usb-redir,chardev=c; ends "
                     "when QEMU does, or when a fault takes the printer away");
  program.add_option("--serial", options.serial, "its serial number")->capture_default_str();
  program.add_option("--layer-ms", layer_ms, "how long it prints at one layer")
      ->capture_default_str();
  program.add_option("--fault", faults,
                     "FAULT@LAYERxTIMES:MS, such as stall@12x1:0; may be repeated");
  program.add_option("-o,--output", out, "folder for what it printed: a slice stack for each job")
      ->required();
  CLI11_PARSE(program, argc, argv);
  options.layer_time = std::chrono::milliseconds(layer_ms);
  for (const std::string& text : faults) {
    const auto fault = parse_fault(text);
    if (!fault) {
      fmt::print(stderr, "binderjet-emulator: --fault {}: no such fault; there are:", text);
      for (const PrinterFault one : all_printer_faults())
        fmt::print(stderr, " {}", fault_word(one));
      fmt::print(stderr, "\n");
      return 2;
    }
    options.plan.push_back(*fault);
  }
  std::signal(SIGINT, ask_to_stop);
  std::signal(SIGTERM, ask_to_stop);
  PrinterEmulator printer(options);
  if (!serve(printer, usbredir, port)) return 4;
  try {
    int number = 0;
    for (const EmulatedJob& job : printer.jobs()) {
      ++number;
      const std::string folder = fmt::format("{}/{}", out, number);
      write_measured(print_volume(job), folder);
      fmt::print("{}: {} of {} layers{}\n", folder, job.layers.size(), job.layer_count,
                 job.done ? "" : ", unfinished");
    }
  } catch (const std::exception& error) {
    fmt::print(stderr, "binderjet-emulator: {}\n", error.what());
    return 3;
  }
  return 0;
}
