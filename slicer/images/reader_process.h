// SPDX-License-Identifier: GPL-3.0-or-later
// One running binderjet-read.
#pragma once

#include <sys/types.h>

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "slicer/images/message.h"

namespace binderjet {

struct ReaderAnswer {
  ImageReply reply;
  std::vector<std::byte> content;
};

class ReaderProcess {
 public:
  // Error{kUsage} if the program cannot be started.
  ReaderProcess();
  // Lets it end, and waits for that.
  ~ReaderProcess();
  ReaderProcess(const ReaderProcess&) = delete;
  ReaderProcess& operator=(const ReaderProcess&) = delete;

  // Nothing if the process ended, or says what is not in message.h. It then takes no more requests.
  std::optional<ReaderAnswer> ask(const ImageRequest& request, std::span<const std::byte> content);
  // How it ended, in words for a person; to be asked once after ask() gave nothing.
  std::string end();

 private:
  int socket_ = -1;
  pid_t process_ = -1;
  bool said_nonsense_ = false;
};

}  // namespace binderjet
