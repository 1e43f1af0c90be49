// SPDX-License-Identifier: GPL-3.0-or-later
// score JOB --target PART: how far the predicted print is from the model that was wanted.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "driver/console.h"
#include "driver/printed.h"
#include "driver/verbs.h"
#include "slicer/error.h"
#include "slicer/score.h"

namespace binderjet {
namespace {

struct ScoreOptions {
  std::string job;
  std::vector<std::string> targets;
  std::string profile;
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

void score(const ScoreOptions& options, const Console& console) {
  const MaskSource job = open_job(options.job, console);
  const JobHeader& header = *job.header;
  const Profile profile = options.profile.empty() ? header.profile : load_profile(options.profile);
  const PrinterModel model(profile.effects, header.grid);
  const auto target = voxelize(load_target(options, header), header.grid, header.box, job.layers());
  const auto printed = printed_stream(job, model);

  VoxelCounts counts;
  Progress progress(console, "scoring", job.size_px[2]);
  while (target->rest().size() > 0) {
    const auto want = target->next(kBlockLayers);
    const auto got = printed->next(kBlockLayers);
    for (std::size_t i = 0; i < want.size(); ++i) counts += count_voxels(*want[i], *got[i]);
    progress.advance(job.size_px[2] - target->rest().size());
  }
  console.result({{"solid_voxels", counts.solid},
                  {"wrong", counts.wrong()},
                  {"floor", counts.floor()},
                  {"excess", counts.excess()}},
                 fmt::format("wrong {:.4f} of {} solid voxels, {:.4f} of it unavoidable at this "
                             "layer height, excess {:.4f}",
                             counts.wrong(), counts.solid, counts.floor(), counts.excess()));
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
  verb->callback([options, console = add_console_options(*verb)] { score(*options, *console); });
}

}  // namespace binderjet
