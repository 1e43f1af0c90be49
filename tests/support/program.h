// SPDX-License-Identifier: GPL-3.0-or-later
// The real program, run as a person runs it, in a folder that goes away again.
#pragma once

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace binderjet {

struct Ran {
  int status = -1;  // the exit status; 128 + the signal that ended it
  std::string out;
  std::string err;
  double peak_rss_mb = 0;
  double seconds = 0;  // by the clock on the wall
  double cpu_seconds = 0;

  nlohmann::json json() const { return nlohmann::json::parse(out); }
};

class Workplace {
 public:
  Workplace() {
    std::string name = (std::filesystem::temp_directory_path() / "binderjet-test-XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) std::abort();
    folder_ = name;
  }
  ~Workplace() {
    std::error_code error;
    std::filesystem::remove_all(folder_, error);
  }
  Workplace(const Workplace&) = delete;
  Workplace& operator=(const Workplace&) = delete;

  std::string operator/(const std::string& name) const { return (folder_ / name).string(); }

  // By the clock, after which SIGALRM ends what run() starts; 0 is never.
  unsigned wall_seconds = 0;

  // `words` follow the program's name; more than `seconds` of computing or `memory_mb` of address
  // space end it. `meanwhile` is called once it runs.
  Ran run(const std::vector<std::string>& words, unsigned seconds = 600,
          [[maybe_unused]] std::size_t memory_mb = 0,
          const std::function<void(pid_t)>& meanwhile = {}) const {
    Ran ran;
    const auto start = std::chrono::steady_clock::now();
    std::fflush(nullptr);  // or the child writes once more what we have not yet written
    const pid_t child = fork();
    if (child == 0) {
      std::signal(SIGINT, SIG_DFL);  // which who runs the tests by & has told them to ignore
      limit(RLIMIT_CPU, seconds);
      alarm(wall_seconds);
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)  // their shadow is terabytes
      if (memory_mb != 0) limit(RLIMIT_AS, memory_mb << 20);
#endif
      std::vector<char*> argv = {const_cast<char*>(BINDERJET_PROGRAM)};
      for (const std::string& word : words) argv.push_back(const_cast<char*>(word.c_str()));
      argv.push_back(nullptr);
      if (std::freopen((folder_ / "out.txt").c_str(), "w", stdout) == nullptr ||
          std::freopen((folder_ / "err.txt").c_str(), "w", stderr) == nullptr) {
        _exit(126);
      }
      execv(argv[0], argv.data());
      _exit(127);
    }
    if (meanwhile) meanwhile(child);
    int status = 0;
    rusage usage{};
    wait4(child, &status, 0, &usage);
    ran.status = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    ran.out = text("out.txt");
    ran.err = text("err.txt");
    ran.peak_rss_mb = static_cast<double>(usage.ru_maxrss) / 1024;
    ran.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    ran.cpu_seconds = in_seconds(usage.ru_utime) + in_seconds(usage.ru_stime);
    return ran;
  }

  std::string text(const std::string& name) const {
    std::ifstream file(folder_ / name, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }

 private:
  static double in_seconds(const timeval& time) {
    return static_cast<double>(time.tv_sec) + static_cast<double>(time.tv_usec) * 1e-6;
  }
  static void limit(int resource, rlim_t most) {
    const rlimit limits{most, most};
    setrlimit(static_cast<__rlimit_resource>(resource), &limits);
  }

  std::filesystem::path folder_;
};

// The models and measurements that are not part of the repository; empty where they are absent.
inline std::filesystem::path data_folder() {
  const char* given = std::getenv("BINDERJET_DATA");
  const std::filesystem::path folder =
      given != nullptr ? std::filesystem::path(given)
                       : std::filesystem::path(BINDERJET_SOURCE_DIR) / "../shared/data";
  return std::filesystem::is_directory(folder) ? folder : std::filesystem::path();
}

}  // namespace binderjet
