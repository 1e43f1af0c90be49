// SPDX-License-Identifier: GPL-3.0-or-later
// What every verb says to a person or to a script: one JSON object on stdout, all else on stderr.
#pragma once

#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "slicer/base/work.h"

namespace CLI {
class App;
}

namespace binderjet {

class ProgressLine;

struct Console {
  bool json = false;   // --json: the result is one JSON object on stdout
  bool quiet = false;  // -q: nothing but warnings and errors on stderr

  Console();

  // Prints the result: `json` itself with --json, otherwise `text` on stdout unless -q.
  void result(const nlohmann::ordered_json& object, const std::string& text) const;
  void warning(const std::string& text) const;
  // What a person may want to know, on stderr; not with -q.
  void note(const std::string& text) const;
  // For long work: what it does is seen on a terminal, unless -q; its notes are printed, unless -q
  // or --json; it ends with Error{kInterrupted} after Ctrl-C. Good as long as the console or a copy
  // of it lives.
  Work work() const;

 private:
  std::shared_ptr<ProgressLine> line_;
};

// Adds --json and -q to a verb. The console lives as long as the verb's callback holds it.
std::shared_ptr<Console> add_console_options(CLI::App& verb);

}  // namespace binderjet
