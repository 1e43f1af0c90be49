// SPDX-License-Identifier: GPL-3.0-or-later
// slice PART... -p PROFILE -o JOB: models in, a printable job out.
#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/task_arena.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <memory>
#include <optional>

#include "driver/export/demand_apart.h"
#include "driver/job/encoded_layers.h"
#include "driver/job/estimate.h"
#include "driver/job/slice_plan.h"
#include "driver/job/unfinished_slice.h"
#include "driver/verbs/verbs.h"
#include "slicer/base/error.h"

namespace binderjet {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

void slice_rest(const SlicePlan& plan, LayerRange range, UnfinishedSlice& unfinished,
                const Work& work) {
  const LayerRange rest = unfinished.rest();
  if (rest.size() == 0) return;
  const auto stream = encoded_layers(plan.header, plan.mesh, plan.color, work).layers(rest);
  Stage stage(work, "slicing", range.size(), "layers", unfinished.totals().layers);
  // A stop costs the block under way, which shall be a fiftieth of the work or seconds of it, and
  // still keep the cores busy.
  constexpr double kLongBlock = 4;
  const int cores = oneapi::tbb::this_task_arena::max_concurrency();
  int block = std::clamp(range.size() / 50, std::min(cores, kBlockLayers), kBlockLayers);
  while (stream->rest().size() > 0) {
    const auto start = Clock::now();
    unfinished.append(stream->next(block));
    stage.reach(unfinished.totals().layers);
    if (seconds_since(start) > kLongBlock) block = std::max(1, block / 2);
  }
}

void slice(const SliceOptions& options, std::optional<int> threads, bool restart,
           const Console& console) {
  const auto start = Clock::now();
  std::optional<oneapi::tbb::global_control> cores;
  if (threads) {
    cores.emplace(oneapi::tbb::global_control::max_allowed_parallelism,
                  static_cast<std::size_t>(*threads));
  }
  demand_apart({options.out}, options.parts);
  const SlicePlan plan = plan_slices(options, console);
  const LayerRange range = layer_range(options.layers, plan.header.layers());
  UnfinishedSlice unfinished(options.out, plan, range, restart, console);
  const int kept = unfinished.totals().layers;
  try {
    slice_rest(plan, range, unfinished, console.work());
    unfinished.finish();
  } catch (const Error& error) {
    throw Error(error.kind(), "", error.what() + unfinished.kept());
  }
  Totals totals = unfinished.totals();
  totals.kept = kept;
  totals.seconds = seconds_since(start);
  report(plan.header, totals, options.out, plan.warnings, console);
}

}  // namespace

void add_slice_verb(CLI::App& program) {
  CLI::App* verb = program.add_subcommand("slice", "turn models into a printable job");
  auto options = std::make_shared<SliceOptions>();
  auto threads = std::make_shared<std::optional<int>>();
  auto restart = std::make_shared<bool>(false);
  verb->add_option("PART", options->parts, "models: STL, PLY, OBJ, OFF, 3MF, glTF and others")
      ->required();
  verb->add_option("-p,--profile", options->profile, "a printer profile's name or path")
      ->required();
  verb->add_option("-o,--output", options->out, "the job to write (.bjob)")->required();
  add_slice_options(*verb, *options);
  verb->add_option("--layers", options->layers, "A:B, slice only layers A <= k < B (see join)");
  verb->add_option("--threads", *threads, "how many cores to use; the result is the same")
      ->check(CLI::Range(1, 1024));
  verb->add_flag("--restart", *restart,
                 "begin anew, also where an interrupted slice left layers to go on with");
  verb->callback([options, threads, restart, console = add_console_options(*verb)] {
    slice(*options, *threads, *restart, *console);
  });
}

}  // namespace binderjet
