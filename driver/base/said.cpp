// SPDX-License-Identifier: GPL-3.0-or-later
#include "driver/base/said.h"

#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

#include <array>
#include <cstdio>

#include "slicer/base/byte_text.h"
#include "slicer/base/whole_file.h"

namespace binderjet {

void hold_standard_files() {
  // Not for writing: a result that nobody gets is an error, and must not vanish as if all were
  // well.
  for (int fd = STDIN_FILENO; fd <= STDERR_FILENO; ++fd) {
    if (::fcntl(fd, F_GETFD) < 0) static_cast<void>(::open("/dev/null", O_RDONLY));
  }
}

void say_line(const std::string& text) noexcept {
  try {
    const std::string line = visible_line(text) + "\n";
    std::fwrite(line.data(), 1, line.size(), stderr);
    std::fflush(stderr);
    std::clearerr(stderr);
  } catch (...) {  // out of memory: then there is nothing to say it with
  }
}

// Not by stdio, where the work may be waiting.
void say_aside(const std::string& text) noexcept {
  pollfd room{STDERR_FILENO, POLLOUT, 0};
  if (::poll(&room, 1, 0) <= 0) return;
  try {
    const std::string place = ::isatty(STDERR_FILENO) != 0 ? "\r\033[K" : "";
    const std::string line = place + visible_line(text) + "\n";
    if (::write(STDERR_FILENO, line.data(), line.size()) < 0) return;  // nobody can be told
  } catch (...) {                                                      // as in say_line()
  }
}

void say_result(const std::string& text) {
  const std::string out = visible(text) + "\n";
  const bool good = std::fwrite(out.data(), 1, out.size(), stdout) == out.size();
  if (std::fflush(stdout) != 0 || !good) fail_to_write("the result (standard output)");
}

}  // namespace binderjet
