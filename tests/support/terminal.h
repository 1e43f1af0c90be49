// SPDX-License-Identifier: GPL-3.0-or-later
// The program at a terminal: what is written to it, and what then stands on its screen.
#pragma once

#include <pty.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <string>
#include <vector>

namespace binderjet {

struct AtTerminal {
  int status = -1;
  std::string written;  // byte for byte

  // The lines that are left to read, as a terminal that knows \r, \n and "erase to the end of the
  // line" shows them.
  std::vector<std::string> screen() const {
    std::vector<std::string> lines(1);
    std::size_t at = 0;
    for (std::size_t i = 0; i < written.size(); ++i) {
      std::string& line = lines.back();
      if (written[i] == '\r') {
        at = 0;
      } else if (written[i] == '\n') {
        lines.emplace_back();
        at = 0;
      } else if (written.compare(i, 3, "\033[K") == 0) {
        line.resize(std::min(line.size(), at));
        i += 2;
      } else {
        line.resize(std::max(line.size(), at + 1), ' ');
        line[at++] = written[i];
      }
    }
    return lines;
  }
  // What was painted over later, in the order of painting.
  std::vector<std::string> painted() const {
    const std::string begin = "\r\033[K";
    std::vector<std::string> all;
    for (std::size_t at = written.find(begin); at != std::string::npos;) {
      const std::size_t next = written.find(begin, at + 1);
      const std::string text = written.substr(at + begin.size(), next - at - begin.size());
      if (next != std::string::npos && !text.empty() && text.find('\n') == std::string::npos) {
        all.push_back(text);
      }
      at = next;
    }
    return all;
  }
};

// Runs the program with stdout and stderr on a terminal of so many columns, where each step of its
// progress is painted.
inline AtTerminal run_at_terminal(const std::vector<std::string>& words, int columns = 100) {
  winsize size{};
  size.ws_row = 25;
  size.ws_col = static_cast<unsigned short>(columns);
  int terminal = -1;
  const pid_t child = forkpty(&terminal, nullptr, nullptr, &size);
  if (child == 0) {
    setenv("BINDERJET_PROGRESS_AFTER", "0", 1);
    std::vector<char*> argv = {const_cast<char*>(BINDERJET_PROGRAM)};
    for (const std::string& word : words) argv.push_back(const_cast<char*>(word.c_str()));
    argv.push_back(nullptr);
    execv(argv[0], argv.data());
    _exit(127);
  }
  AtTerminal ran;
  std::array<char, 4096> bytes{};
  // A terminal that nobody writes to any more reads as an error.
  for (ssize_t got = 0; (got = read(terminal, bytes.data(), bytes.size())) > 0;) {
    ran.written.append(bytes.data(), static_cast<std::size_t>(got));
  }
  close(terminal);
  int status = 0;
  waitpid(child, &status, 0);
  ran.status = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  return ran;
}

}  // namespace binderjet
