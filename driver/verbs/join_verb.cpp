// SPDX-License-Identifier: GPL-3.0-or-later
// join: the shares that a cluster sliced become one job.
#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "driver/base/console.h"
#include "driver/base/transport_errors.h"
#include "driver/send/whole_job_file.h"
#include "driver/verbs/verbs.h"
#include "transport/job/job_file.h"

namespace binderjet {

void add_join_verb(CLI::App& program) {
  struct Options {
    std::vector<std::string> shares;
    std::string out;
  };
  CLI::App* verb =
      program.add_subcommand("join", "put the shares of a job together (slice --layers A:B)");
  const auto options = std::make_shared<Options>();
  verb->add_option("SHARE", options->shares, "job files that slice --layers wrote, in any order")
      ->required();
  verb->add_option("-o,--output", options->out, "the whole job")->required();
  const auto console = add_console_options(*verb);
  verb->callback([options, console] {
    const int layers = job_layer_count(value_or_throw(JobReader::open(options->shares.front())));
    Stage stage(console->work(), "joining", layers, "layers");
    value_or_throw(join_jobs(options->shares, options->out, layers,
                             [&stage](int layer) { stage.reach(layer); }));
    nlohmann::ordered_json result;
    result["job"] = options->out;
    result["shares"] = options->shares.size();
    result["layers"] = layers;
    console->result(result, fmt::format("{}: {} layers from {} shares", options->out, layers,
                                        options->shares.size()));
  });
}

}  // namespace binderjet
