// SPDX-License-Identifier: GPL-3.0-or-later
// Where an emulated printer listens: FOLDER/printer.socket, for its user alone.
//
// The socket is reached through a descriptor of its folder, so the folder's path may be as long as
// the system allows; a socket's own name may have 107 bytes. Who serves a folder holds its lock
// (flock), which ends with the process: a socket without the lock is what a killed one left.
#pragma once

#include <string>

#include "transport/base/file.h"
#include "transport/base/result.h"

namespace binderjet {

class PrinterSocket {
 public:
  // Makes the folder if only that is missing. kDevice if another emulator serves it, or it cannot
  // be had.
  static Result<PrinterSocket> listen(const std::string& folder);
  PrinterSocket(PrinterSocket&&) noexcept = default;
  PrinterSocket& operator=(PrinterSocket&&) = delete;
  ~PrinterSocket();  // takes the socket away

  int fd() const { return listener_.fd(); }  // does not block
  const std::string& folder() const { return folder_; }

 private:
  PrinterSocket(std::string folder, File lock, File listener);

  std::string folder_;
  File lock_;  // of the folder itself
  File listener_;
};

// A connection to the printer that listens in a folder; it does not block. kDevice if none does.
Result<File> connect_to_printer(const std::string& folder);

}  // namespace binderjet
