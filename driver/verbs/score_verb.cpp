// SPDX-License-Identifier: GPL-3.0-or-later
// score JOB [--target PART]: how far the predicted print is from the model that was wanted.
#include <fmt/format.h>
#include <oneapi/tbb/parallel_for.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "driver/base/console.h"
#include "driver/job/mask_source.h"
#include "driver/job/parts.h"
#include "driver/report/located_faults.h"
#include "driver/report/score_map.h"
#include "driver/report/score_sheet.h"
#include "driver/verbs/verbs.h"
#include "slicer/base/error.h"
#include "slicer/model/process_window.h"

namespace binderjet {
namespace {

struct ScoreOptions {
  std::string job;
  std::vector<std::string> targets;
  std::string profile;
  std::string map;
  bool compare = false;
};

struct Target {
  std::shared_ptr<const Mesh> mesh;
  bool is_sliced = true;  // the job was sliced from these very files
};

// The job's own models, or what is named in their place, placed as they are.
Target load_target(const ScoreOptions& options, const JobHeader& header, const Work& work) {
  if (options.targets.empty()) {
    const std::string folder = std::filesystem::path(options.job).parent_path().string();
    return {reload_parts(header, folder, work)};
  }
  if (options.targets.size() != header.sources.size()) {
    throw Error(ErrorKind::kUsage, "--target",
                fmt::format("the job has {} parts; name each of them, in its order",
                            header.sources.size()));
  }
  Target target;
  std::vector<Part> parts;
  for (std::size_t i = 0; i < options.targets.size(); ++i) {
    const Source& source = header.sources[i];
    parts.push_back(
        load_part(options.targets[i], source.placement.unit_mm, source.placement, false, work));
    target.is_sliced = target.is_sliced && parts.back().source.hash == source.hash;
    parts.back().source.corner_px = source.corner_px;
  }
  target.mesh = std::make_shared<const Mesh>(merge_parts(std::move(parts), header.grid));
  return target;
}

std::string edge_text(const EdgeErrors& edges) {
  // What lies farther off is not searched, so a mean over it would say nothing.
  if (edges.p95_mm() >= EdgeErrors::kMaxMm) {
    return fmt::format("more than 5 % of the edges have no printed edge within {:g} mm",
                       EdgeErrors::kMaxMm);
  }
  return fmt::format("edges off by {:.3f} mm on average, 95 % by less than {:.3f} mm",
                     edges.mean_mm(), edges.p95_mm());
}

std::string deepest_text(const ScoreSheet& sheet) {
  if (sheet.deepest.is_null()) return "nothing is wrong beyond what the layer height costs";
  const double p999_mm = sheet.score.depths.p999_mm();
  return fmt::format(
      "deepest wrong place: {}\n{}", place_text(sheet.deepest),
      p999_mm < Depths::kMaxMm
          ? fmt::format("99.9 % of what is wrong: at most {:.3f} mm deep", p999_mm)
          : fmt::format("more than 0.1 % of what is wrong: deeper than {:g} mm", Depths::kMaxMm));
}

std::string text_of(const ScoreSheet& sheet) {
  const VoxelCounts& counts = sheet.score.voxels;
  const FaultCounts& faults = sheet.score.faults;
  return fmt::format(
      "wrong {:.4f} of {} solid voxels, {:.4f} of it unavoidable at this layer height, "
      "excess {:.4f}\nif the printer is a little off: excess {:.4f} on average, at worst {:.4f}\n"
      "{}\n{}\nfaults: {} lost, {} fused, {} spurious, {} loose, {} joined",
      counts.wrong(), counts.solid, counts.floor(), counts.excess(), sheet.window_mean,
      sheet.window_worst, deepest_text(sheet), edge_text(sheet.score.edges),
      faults[FaultKind::kLost], faults[FaultKind::kFused], faults[FaultKind::kSpurious],
      faults[FaultKind::kLoose], faults[FaultKind::kJoined]);
}

std::string table_row(const std::string& enhance, const ScoreSheet& sheet) {
  const std::optional<WrongPlace>& deepest = sheet.score.depths.worst();
  const double depth_mm = deepest ? deepest->depth_mm : 0;
  const bool farther = depth_mm >= Depths::kMaxMm;
  std::string row = fmt::format("\n{:8} {:7.4f} {:7.4f} {:7.4f} {:>8} {:8.3f}", enhance,
                                sheet.score.voxels.excess(), sheet.window_mean, sheet.window_worst,
                                fmt::format("{}{:.3f}", farther ? ">" : "", depth_mm),
                                sheet.score.edges.mean_mm());
  for (const FaultKind kind : kFaultKinds) row += fmt::format(" {:>8}", sheet.score.faults[kind]);
  return row;
}

void score(const ScoreOptions& options, const Console& console) {
  const MaskSource job = open_job(options.job, console);
  const JobHeader& header = *job.header;
  const Profile profile = options.profile.empty() ? header.profile : load_profile(options.profile);
  const std::vector<PrinterModel> models =
      process_window(profile.effects, header.grid, job.place());
  const Work work = console.work();
  const Target target = load_target(options, header, work);

  std::optional<ScoreMap> map;
  if (!options.map.empty()) map.emplace(options.map, job, header.grid);
  int done = 0;
  const auto draw = [&](const std::vector<Shared<LayerScore>>& layers,
                        const std::vector<Fault>& ended) {
    if (!map) return;
    oneapi::tbb::parallel_for(0, static_cast<int>(layers.size()), [&](int i) {
      map->write(done + i, *layers[static_cast<std::size_t>(i)]);
    });
    done += static_cast<int>(layers.size());
    map->add(ended);
  };
  const ScoreSheet own = score_masks(job, header, target.mesh, models, work, draw);
  if (map) map->finish(own.score);

  nlohmann::ordered_json json = to_json(own);
  std::string text = text_of(own);
  if (options.compare) {
    text += "\n\nmasks     excess    mean   worst  deep mm  edge mm";
    for (const FaultKind kind : kFaultKinds) text += fmt::format(" {:>8}", word(kind));
    JobHeader other = header;
    other.profile = profile;
    for (const Enhancement each : kEnhancements) {
      const std::string enhance = word(each);
      other.enhance = each;
      const Stage stage(work, enhance);
      // What the job holds is not made again.
      const bool is_own = each == header.enhance && options.profile.empty() && target.is_sliced;
      const ScoreSheet sheet = is_own ? own
                                      : score_masks(enhanced_masks(job, other, target.mesh, work),
                                                    header, target.mesh, models, work);
      json["compare"][enhance] = to_json(sheet);
      text += table_row(enhance, sheet);
    }
  }
  console.result(json, text);
}

}  // namespace

void add_score_verb(CLI::App& program) {
  CLI::App* verb =
      program.add_subcommand("score", "compare a job's predicted print with its model");
  auto options = std::make_shared<ScoreOptions>();
  verb->add_option("JOB", options->job, "a job (.bjob)")->required();
  verb->add_option(
      "--target", options->targets,
      "the model that is wanted, one per part of the job; else what it was sliced from");
  verb->add_option("-p,--profile", options->profile, "another printer than the job's own");
  verb->add_option(
      "--map", options->map,
      "a folder to write: what is missing, extra, lost and fused in each layer as PNGs, "
      "and features.json");
  verb->add_flag("--compare", options->compare,
                 "also score the masks without enhancement, of the paper's rule and inverse ones");
  verb->callback([options, console = add_console_options(*verb)] { score(*options, *console); });
}

}  // namespace binderjet
