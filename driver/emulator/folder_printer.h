// SPDX-License-Identifier: GPL-3.0-or-later
// An emulated printer in a folder: it listens at FOLDER/printer.socket, and FOLDER/ID is what job
// ID became. For a program of its own, or in a thread of the program that prints.
#pragma once

#include <atomic>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include "driver/emulator/measured_prints.h"
#include "transport/emulator/printer_emulator.h"
#include "transport/emulator/printer_socket.h"

namespace binderjet {

class FolderPrinter {
 public:
  // Error{kDevice} if another emulator has the folder. Held jobs of an earlier one are forgotten:
  // what they were has ended with it.
  FolderPrinter(const std::string& folder, EmulatorOptions options, MeasuredPrints::Say say);

  // Until `stop`, which is asked at least ten times a second, or until the disk is full.
  void serve(const std::function<bool()>& stop);

 private:
  PrinterSocket socket_;
  MeasuredPrints prints_;
  PrinterEmulator printer_;
};

// A printer that this program plays as long as the object lives.
class PlayedPrinter {
 public:
  explicit PlayedPrinter(const std::string& folder);
  ~PlayedPrinter();
  PlayedPrinter(const PlayedPrinter&) = delete;
  PlayedPrinter& operator=(const PlayedPrinter&) = delete;

  // Ends it, and throws what had ended it before.
  void stop();
  // Why nothing is written of the newest job that is done; "" where all is.
  std::string why_not();

 private:
  std::mutex mutex_;
  std::string why_not_;
  FolderPrinter printer_;
  std::atomic<bool> stopped_{false};
  std::exception_ptr failure_;
  std::thread thread_;  // last: it uses all of the above
};

// Plays the printer of an emulator: URI where none is running; null for any other URI.
std::unique_ptr<PlayedPrinter> play_printer(const std::string& uri);

}  // namespace binderjet
