// SPDX-License-Identifier: GPL-3.0-or-later
// What every verb says to a person or to a script: one JSON object on stdout, all else on stderr.
#pragma once

#include <chrono>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>

namespace CLI {
class App;
}

namespace binderjet {

struct Console {
  bool json = false;   // --json: the result is one JSON object on stdout
  bool quiet = false;  // -q: nothing but warnings and errors on stderr

  // Prints the result: `json` itself with --json, otherwise `text` on stdout unless -q.
  void result(const nlohmann::ordered_json& object, const std::string& text) const;
  void warning(const std::string& text) const;
  // What a person may want to know, on stderr; not with -q.
  void note(const std::string& text) const;
};

// Adds --json and -q to a verb. The console lives as long as the verb's callback holds it.
std::shared_ptr<Console> add_console_options(CLI::App& verb);

// A bar on a terminal with layers, rate and time left; silent elsewhere and with -q.
// Throws Error{kInterrupted} from advance() after Ctrl-C, so that every long loop ends cleanly.
class Progress {
 public:
  Progress(const Console& console, std::string label, int total);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void advance(int done);  // `done` of `total` layers are done

 private:
  using Clock = std::chrono::steady_clock;
  std::string label_;
  int total_;
  bool visible_;
  Clock::time_point start_;
  Clock::time_point last_;
};

// From here on Ctrl-C and SIGTERM are answered by check_interrupt() instead of by sudden death.
void catch_interrupts();
// Whether a signal came.
bool interrupted();
// Throws Error{kInterrupted} if a signal came.
void check_interrupt();

}  // namespace binderjet
