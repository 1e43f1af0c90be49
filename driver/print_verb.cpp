// SPDX-License-Identifier: GPL-3.0-or-later
// print: a job file goes to a device, a spool or a file.
#include <CLI/CLI.hpp>
#include <memory>
#include <optional>
#include <string>

#include "driver/console.h"
#include "driver/send.h"
#include "driver/verbs.h"

namespace binderjet {

void add_print_verb(CLI::App& program) {
  struct Options {
    std::string job;
    std::string to;
  };
  CLI::App* verb = program.add_subcommand("print", "send a job to a printer");
  const auto options = std::make_shared<Options>();
  verb->add_option("JOB", options->job, "a .bjob file, as slice writes it")->required();
  verb->add_option("--to", options->to, "spool:DIR or file:PATH")->required();
  const auto console = add_console_options(*verb);
  verb->callback(
      [options, console] { send_job(*console, options->job, options->to, std::nullopt); });
  add_queue_verbs(program);
}

}  // namespace binderjet
