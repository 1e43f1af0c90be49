// SPDX-License-Identifier: GPL-3.0-or-later
// The real program in the background: what it says as it says it, signals, and how it ended.
#pragma once

#include <fcntl.h>
#include <grp.h>
#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <csignal>
#include <string>
#include <utility>
#include <vector>

namespace binderjet {

struct Ended {
  int status = -1;  // the exit status; 128 + the signal that ended it
  std::string out;
  std::string err;     // all of it, with what line() has given
  double seconds = 0;  // since the last signal, or the start
};

class Started {
 public:
  // `words` follow the program's name. As nobody, without any rights, where root asks for it.
  explicit Started(const std::vector<std::string>& words, bool as_nobody = false) {
    std::array<int, 2> out{};
    std::array<int, 2> err{};
    if (pipe2(out.data(), O_CLOEXEC) != 0 || pipe2(err.data(), O_CLOEXEC) != 0) std::abort();
    std::vector<std::string> all = {BINDERJET_PROGRAM};
    all.insert(all.end(), words.begin(), words.end());
    std::vector<char*> argv;
    for (std::string& word : all) argv.push_back(word.data());
    argv.push_back(nullptr);
    child_ = fork();
    if (child_ == 0) {
      std::signal(SIGINT, SIG_DFL);  // which who runs the tests by & has told them to ignore
      dup2(out[1], STDOUT_FILENO);
      dup2(err[1], STDERR_FILENO);
      // Opened before: nobody need not come into the folder that this was built in.
      const int program = open(BINDERJET_PROGRAM, O_RDONLY | O_CLOEXEC);
      if (as_nobody && getuid() == 0 &&
          (setgroups(0, nullptr) != 0 || setgid(65534) != 0 || setuid(65534) != 0)) {
        _exit(126);
      }
      fexecve(program, argv.data(), environ);
      _exit(127);
    }
    close(out[1]);
    close(err[1]);
    out_ = out[0];
    err_ = err[0];
  }
  ~Started() {
    if (child_ > 0) {
      kill(child_, SIGKILL);
      waitpid(child_, nullptr, 0);
    }
    close(out_);
    close(err_);
  }
  Started(const Started&) = delete;
  Started& operator=(const Started&) = delete;

  // The next line that it says on stderr; "" once it says no more, or for 60 s.
  std::string line() {
    while (said_.find('\n', given_) == std::string::npos && read_from(err_, said_)) {
    }
    const std::size_t end = std::min(said_.find('\n', given_), said_.size());
    std::string text = said_.substr(given_, end - given_);
    given_ = std::min(end + 1, said_.size());
    return text;
  }
  void signal(int number) {
    start_ = Clock::now();
    kill(child_, number);
  }
  Ended end() {
    Ended ended;
    while (read_from(err_, said_)) {
    }
    while (read_from(out_, ended.out)) {
    }
    int status = 0;
    waitpid(std::exchange(child_, -1), &status, 0);
    ended.seconds = std::chrono::duration<double>(Clock::now() - start_).count();
    ended.status = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    ended.err = said_;
    return ended;
  }

 private:
  using Clock = std::chrono::steady_clock;

  static bool read_from(int fd, std::string& text) {
    pollfd ready{fd, POLLIN, 0};
    if (poll(&ready, 1, 60'000) <= 0) return false;
    std::array<char, 4096> piece{};
    const ssize_t got = read(fd, piece.data(), piece.size());
    if (got > 0) text.append(piece.data(), static_cast<std::size_t>(got));
    return got > 0;
  }

  pid_t child_ = -1;
  int out_ = -1;
  int err_ = -1;
  std::string said_;
  std::size_t given_ = 0;
  Clock::time_point start_ = Clock::now();
};

}  // namespace binderjet
