// SPDX-License-Identifier: GPL-3.0-or-later
// print: a job file, or parts as they are sliced, go to a printer, a spool or a file.
#include <CLI/CLI.hpp>
#include <memory>
#include <string>

#include "driver/base/console.h"
#include "driver/job/slice_options.h"
#include "driver/send/send.h"
#include "driver/verbs/verbs.h"
#include "slicer/base/error.h"
#include "transport/open/open_backend.h"

namespace binderjet {
namespace {

struct PrintOptions {
  SliceOptions slice;
  std::string to;
  bool stream = false;
};

void print(const PrintOptions& options, const Console& console) {
  const std::vector<std::string>& files = options.slice.parts;
  if (is_job_file(files.front())) {
    if (files.size() > 1) throw Error(ErrorKind::kUsage, files[1], "one job at a time");
    // A job's layers are read as they are sent, so --stream changes nothing.
    send_job(console, files.front(), options.to);
    return;
  }
  // Parts are always sent as they are sliced; --stream says it aloud.
  if (options.slice.profile.empty()) {
    throw Error(ErrorKind::kUsage, "-p", "printing parts needs a printer's profile");
  }
  send_parts(console, options.slice, options.to);
}

}  // namespace

void add_print_verb(CLI::App& program) {
  CLI::App* verb = program.add_subcommand("print", "send a job or parts to a printer");
  const auto options = std::make_shared<PrintOptions>();
  verb->add_option("JOB_OR_PART", options->slice.parts,
                   "a .bjob file as slice writes it, or models, sliced as they are sent")
      ->required();
  verb->add_option("--to", options->to, scheme_forms())->required();
  verb->add_flag("--stream", options->stream,
                 "send each layer of a model as soon as it is sliced, as without this word");
  verb->add_option("-p,--profile", options->slice.profile, "a printer profile's name or path");
  add_slice_options(*verb, options->slice);
  const auto console = add_console_options(*verb);
  verb->callback([options, console] { print(*options, *console); });
}

}  // namespace binderjet
