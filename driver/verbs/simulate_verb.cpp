// SPDX-License-Identifier: GPL-3.0-or-later
// simulate JOB_OR_STACK -p PROFILE -o DIR: what the printer model says comes out of the powder.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "driver/base/console.h"
#include "driver/job/print_stream.h"
#include "driver/verbs/verbs.h"

namespace binderjet {
namespace {

struct SimulateOptions {
  std::string masks;
  std::string profile;
  std::string out;
};

void simulate(const SimulateOptions& options, const Console& console) {
  const Profile profile = load_profile(options.profile);
  const MaskSource masks = open_masks(options.masks, console);
  // The masks say where their pixels are; the profile says how finely the model looks at them.
  const Grid grid{masks.pitch_mm, profile.detail_vx};
  const Grid own = profile.grid(std::nullopt);
  for (std::size_t axis = 0; axis < 2; ++axis) {
    constexpr double kSamePitch = 1e-3;
    if (std::abs(grid.pitch_mm[axis] / own.pitch_mm[axis] - 1) > kSamePitch) {
      console.warning(fmt::format("{}: pixels of {:.4g} x {:.4g} mm, but {} prints {:.4g} x {:.4g}",
                                  masks.path, grid.pitch_mm[0], grid.pitch_mm[1], profile.name,
                                  own.pitch_mm[0], own.pitch_mm[1]));
      break;
    }
  }
  write_printed(masks, PrinterModel(profile.effects, grid, masks.place()), grid, options.out,
                console.work())();
  console.result(
      {{"out", options.out}, {"layers", masks.size_px[2]}, {"profile", profile.name}},
      fmt::format("{}: {} layers as {} prints them", options.out, masks.size_px[2], profile.name));
}

}  // namespace

void add_simulate_verb(CLI::App& program) {
  CLI::App* verb = program.add_subcommand("simulate", "predict what a printer makes of masks");
  auto options = std::make_shared<SimulateOptions>();
  verb->add_option("JOB_OR_STACK", options->masks, "a job (.bjob) or a folder of masks")
      ->required();
  verb->add_option("-p,--profile", options->profile, "a printer profile's name or path")
      ->required();
  verb->add_option("-o,--output", options->out, "the folder to write: printed voxels as PNGs")
      ->required();
  verb->callback([options, console = add_console_options(*verb)] { simulate(*options, *console); });
}

}  // namespace binderjet
