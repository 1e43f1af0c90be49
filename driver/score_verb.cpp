// SPDX-License-Identifier: GPL-3.0-or-later
// score JOB --target PART: how far the predicted print is from the model that was wanted.
#include <fmt/format.h>
#include <oneapi/tbb/parallel_for.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "driver/console.h"
#include "driver/printed.h"
#include "driver/score_map.h"
#include "driver/verbs.h"
#include "slicer/error.h"
#include "slicer/score_stream.h"

namespace binderjet {
namespace {

struct ScoreOptions {
  std::string job;
  std::vector<std::string> targets;
  std::string profile;
  std::string map;
};

// The target as the job placed its own parts, read from the files named now.
std::shared_ptr<const Mesh> load_target(const ScoreOptions& options, const JobHeader& header) {
  if (options.targets.size() != header.sources.size()) {
    throw Error(ErrorKind::kUsage, "--target",
                fmt::format("the job has {} parts; name each of them, in its order",
                            header.sources.size()));
  }
  std::vector<Part> parts;
  for (std::size_t i = 0; i < options.targets.size(); ++i) {
    const Source& source = header.sources[i];
    parts.push_back(load_part(options.targets[i], source.placement.unit_mm, source.placement));
    parts.back().source.corner_px = source.corner_px;
  }
  return std::make_shared<const Mesh>(merge_parts(std::move(parts), header.grid));
}

void report(const Score& sum, const Console& console) {
  const VoxelCounts& counts = sum.voxels();
  const EdgeErrors& edges = sum.edges();
  console.result(
      {{"solid_voxels", counts.solid},
       {"wrong", counts.wrong()},
       {"floor", counts.floor()},
       {"excess", counts.excess()},
       {"epe_mm", {{"mean", edges.mean_mm()}, {"p95", edges.p95_mm()}, {"max", edges.max_mm()}}},
       {"lost", sum.lost()},
       {"fused", sum.fused()},
       {"spurious", sum.spurious()}},
      fmt::format("wrong {:.4f} of {} solid voxels, {:.4f} of it unavoidable at this layer height, "
                  "excess {:.4f}\nedges off by {:.3f} mm on average, 95 % by less than {:.3f} mm, "
                  "at most {:.3f} mm\nfeatures: {} lost, {} fused, {} spurious",
                  counts.wrong(), counts.solid, counts.floor(), counts.excess(), edges.mean_mm(),
                  edges.p95_mm(), edges.max_mm(), sum.lost(), sum.fused(), sum.spurious()));
}

void score(const ScoreOptions& options, const Console& console) {
  const MaskSource job = open_job(options.job, console);
  const JobHeader& header = *job.header;
  const Profile profile = options.profile.empty() ? header.profile : load_profile(options.profile);
  const PrinterModel model(profile.effects, header.grid, job.place());
  const auto layers =
      score_layers(voxelize(load_target(options, header), header.grid, header.box, job.layers()),
                   printed_stream(job, model), header.grid, job.layers());

  std::optional<ScoreMap> map;
  if (!options.map.empty()) map.emplace(options.map, job, header.grid);
  Score sum(header.grid, job.first);
  Progress progress(console, "scoring", job.size_px[2]);
  int done = 0;
  while (layers->rest().size() > 0) {
    const auto block = layers->next(kBlockLayers);
    if (map) {
      oneapi::tbb::parallel_for(0, static_cast<int>(block.size()), [&](int i) {
        map->write(done + i, *block[static_cast<std::size_t>(i)]);
      });
    }
    for (const Shared<LayerScore>& layer : block) {
      const std::vector<Feature> ended = sum.add(*layer);
      if (map) map->add(ended);
    }
    done += static_cast<int>(block.size());
    progress.advance(done);
  }
  const std::vector<Feature> ended = sum.finish();
  if (map) {
    map->add(ended);
    map->finish(sum);
  }
  report(sum, console);
}

}  // namespace

void add_score_verb(CLI::App& program) {
  CLI::App* verb =
      program.add_subcommand("score", "compare a job's predicted print with its model");
  auto options = std::make_shared<ScoreOptions>();
  verb->add_option("JOB", options->job, "a job (.bjob)")->required();
  verb->add_option("--target", options->targets,
                   "the model that is wanted, one per part of the job")
      ->required();
  verb->add_option("-p,--profile", options->profile, "another printer than the job's own");
  verb->add_option(
      "--map", options->map,
      "a folder to write: what is missing, extra, lost and fused in each layer as PNGs, "
      "and features.json");
  verb->callback([options, console = add_console_options(*verb)] { score(*options, *console); });
}

}  // namespace binderjet
