// SPDX-License-Identifier: GPL-3.0-or-later
// explain JOB X,Y,LAYER: why a pixel of a mask is on or off.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "driver/base/console.h"
#include "driver/job/mask_source.h"
#include "driver/job/parts.h"
#include "driver/verbs/verbs.h"
#include "slicer/base/error.h"
#include "slicer/enhance/inverse/inverse_solver.h"
#include "slicer/model/process_window.h"
#include "slicer/voxels/voxelize.h"

namespace binderjet {
namespace {

struct ExplainOptions {
  std::string job;
  std::vector<int> pixel;  // x, y, layer
};

// The pixel's layer and those that its print depends on, with their masks in the job.
std::vector<Shared<InverseLayer>> window_of(const MaskSource& job, int layer, int reach,
                                            const Work& work) {
  const JobHeader& header = *job.header;
  const LayerRange range =
      grown({layer, layer + 1}, LayerReach::both_sides(reach), {0, header.layers()});
  const auto mesh =
      reload_parts(header, std::filesystem::path(job.path).parent_path().string(), work);
  Stage stage(work, "reading masks", 2 * reach + 1, "layers");
  const auto targets = voxelize(mesh, header.grid, header.box, range)->next(range.size());
  std::vector<Shared<InverseLayer>> window;
  for (int k = layer - reach; k <= layer + reach; ++k) {
    stage.advance();
    if (k < range.first || k >= range.last || k < job.first || k >= job.layers().last) {
      window.push_back(nullptr);
      continue;
    }
    auto mask = std::make_shared<const RunLayer>(job.read(k - job.first));
    window.push_back(std::make_shared<const InverseLayer>(
        InverseLayer{targets[static_cast<std::size_t>(k - range.first)], mask, mask, k}));
  }
  return window;
}

void explain(const ExplainOptions& options, const Console& console) {
  const MaskSource job = open_job(options.job, console);
  const JobHeader& header = *job.header;
  const int x = options.pixel[0];
  const int y = options.pixel[1];
  const int layer = options.pixel[2];
  if (x < 0 || y < 0 || x >= job.size_px[0] || y >= job.size_px[1] || layer < job.first ||
      layer >= job.layers().last) {
    throw Error(
        ErrorKind::kUsage, "X,Y,LAYER",
        fmt::format("{},{},{} is not within the job's {} x {} pixels, layers {} to {}", x, y, layer,
                    job.size_px[0], job.size_px[1], job.first, job.layers().last - 1));
  }
  const InverseSolver solver(process_window(header.profile.effects, header.grid, job.place()),
                             header.grid, header.profile.mask);
  const PixelReasons why =
      solver.reasons(window_of(job, layer, solver.improve_reach(), console.work()), x, y);
  const auto verdict = [&](std::int64_t grows) {
    const std::string what = why.on ? "clearing" : "setting";
    if (grows == 0) return what + " it changes no count of wrong voxels";
    return fmt::format("{} it makes {} voxels {}", what, std::abs(grows),
                       grows > 0 ? "more wrong" : "fewer wrong");
  };
  const auto list = [](const std::vector<double>& doses) {
    return fmt::format("{:.3f}", fmt::join(doses, " "));
  };
  console.result(
      {{"pixel", {x, y, layer}},
       {"on", why.on},
       {"target_share", why.target_share},
       {"level", why.level},
       {"dose", why.dose},
       {"dose_flipped", why.dose_flipped},
       {"wrong_if_flipped", why.nominal_cost},
       {"wrong_if_flipped_window", why.window_cost},
       {"rules_allow_flip", why.rules_allow}},
      fmt::format("pixel {},{} of layer {} is {}; {:.0f} % of its voxels are in the target\n"
                  "its voxels get a dose of {}, flipped {}; powder binds at {:.3f}\n"
                  "{}; over the process window by weight {:+}{}",
                  x, y, layer, why.on ? "on" : "off", 100 * why.target_share, list(why.dose),
                  list(why.dose_flipped), why.level, verdict(why.nominal_cost), why.window_cost,
                  why.rules_allow ? "" : "\nflipped, it would break the profile's mask rules"));
}

}  // namespace

void add_explain_verb(CLI::App& program) {
  CLI::App* verb = program.add_subcommand("explain", "say why a pixel of a mask is on or off");
  auto options = std::make_shared<ExplainOptions>();
  verb->add_option("JOB", options->job, "a job (.bjob)")->required();
  verb->add_option("PIXEL", options->pixel, "X,Y,LAYER, counted from the job's lower corner")
      ->required()
      ->delimiter(',')
      ->expected(3);
  verb->callback([options, console = add_console_options(*verb)] { explain(*options, *console); });
}

}  // namespace binderjet
