// SPDX-License-Identifier: GPL-3.0-or-later
#include "driver/base/console.h"

#include <unistd.h>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "driver/base/json_text.h"
#include "driver/base/progress_line.h"
#include "driver/base/said.h"

namespace binderjet {

Console::Console() : line_(std::make_shared<ProgressLine>()) {}

void Console::result(const nlohmann::ordered_json& object, const std::string& text) const {
  line_->clear();
  if (json) {
    say_result(to_json_text(object));
  } else if (!quiet && !text.empty()) {
    say_result(text);
  }
}

void Console::warning(const std::string& text) const { line_->say("binderjet: warning: " + text); }

Work Console::work() const {
  line_->configure(!quiet && isatty(STDERR_FILENO) != 0, !quiet && !json);
  return Work(*line_);
}

void Console::note(const std::string& text) const {
  if (!quiet) line_->say(text);
}

std::shared_ptr<Console> add_console_options(CLI::App& verb) {
  auto console = std::make_shared<Console>();
  verb.add_flag("--json", console->json, "print the result as one JSON object on stdout");
  verb.add_flag("-q,--quiet", console->quiet, "say nothing but warnings and errors");
  return console;
}

}  // namespace binderjet
