// SPDX-License-Identifier: GPL-3.0-or-later
// slice PART... -p PROFILE -o JOB: models in, a printable job out.
#include <oneapi/tbb/global_control.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <memory>
#include <optional>

#include "driver/base/transport_errors.h"
#include "driver/export/demand_apart.h"
#include "driver/job/encoded_layers.h"
#include "driver/job/estimate.h"
#include "driver/job/slice_plan.h"
#include "driver/verbs/verbs.h"
#include "transport/job/job_file.h"

namespace binderjet {
namespace {

void slice(const SliceOptions& options, std::optional<int> threads, const Console& console) {
  const auto start = std::chrono::steady_clock::now();
  std::optional<oneapi::tbb::global_control> cores;
  if (threads) {
    cores.emplace(oneapi::tbb::global_control::max_allowed_parallelism,
                  static_cast<std::size_t>(*threads));
  }
  demand_apart({options.out}, options.parts);
  const SlicePlan plan = plan_slices(options, console);
  const LayerRange range = layer_range(options.layers, plan.header.layers());
  JobWriter writer = value_or_throw(JobWriter::create(options.out, to_text(plan.header)));
  const Work work = console.work();
  const auto stream = encoded_layers(plan.header, plan.mesh, plan.color, work).layers(range);
  Totals totals;
  {
    Stage stage(work, "slicing", range.size(), "layers");
    while (stream->rest().size() > 0) {
      for (const Shared<EncodedLayer>& layer : stream->next(kBlockLayers)) {
        value_or_throw(writer.append(layer->record));
        totals.add(*layer);
      }
      stage.reach(totals.layers);
    }
  }
  value_or_throw(writer.finish());
  totals.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  report(plan.header, totals, options.out, plan.warnings, console);
}

}  // namespace

void add_slice_verb(CLI::App& program) {
  CLI::App* verb = program.add_subcommand("slice", "turn models into a printable job");
  auto options = std::make_shared<SliceOptions>();
  auto threads = std::make_shared<std::optional<int>>();
  verb->add_option("PART", options->parts, "models: STL, PLY, OBJ, OFF, 3MF, glTF and others")
      ->required();
  verb->add_option("-p,--profile", options->profile, "a printer profile's name or path")
      ->required();
  verb->add_option("-o,--output", options->out, "the job to write (.bjob)")->required();
  add_slice_options(*verb, *options);
  verb->add_option("--layers", options->layers, "A:B, slice only layers A <= k < B (see join)");
  verb->add_option("--threads", *threads, "how many cores to use; the result is the same")
      ->check(CLI::Range(1, 1024));
  verb->callback([options, threads, console = add_console_options(*verb)] {
    slice(*options, *threads, *console);
  });
}

}  // namespace binderjet
