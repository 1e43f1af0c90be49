// SPDX-License-Identifier: GPL-3.0-or-later
// calibrate -p PROFILE --job JOB --measured STACK... -o DIR: the residual of a profile's model,
// traced to the effects that it lacks.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "driver/calibration_json.h"
#include "driver/console.h"
#include "driver/mask_source.h"
#include "driver/printed.h"
#include "driver/verbs.h"
#include "slicer/calibrate/calibrate.h"
#include "slicer/calibrate/measured.h"
#include "slicer/error.h"
#include "slicer/stack/png.h"

namespace binderjet {
namespace {

namespace fs = std::filesystem;

struct CalibrateOptions {
  std::string profile;
  std::string job;
  std::vector<std::string> measured;
  std::string check_job;
  std::vector<std::string> check_measured;
  std::string out;
};

// The masks of a job and what was measured of it, registered to what the profile predicts.
MeasuredJob read_job(const std::string& name, const std::string& path,
                     const std::vector<std::string>& stacks, const Profile& profile,
                     const Console& console, Progress& progress, int& done) {
  const MaskSource source = open_masks(path, console);
  MeasuredJob job;
  job.name = name;
  job.grid = {source.pitch_mm, profile.detail_vx};
  job.place = source.place();
  job.first_layer = source.first;
  const PrinterModel model(profile.effects, job.grid, job.place);
  const auto stream = printed_stream(source, model);
  std::vector<RunLayer> predicted;
  for (int k = 0; k < source.size_px[2]; ++k) {
    job.masks.push_back(std::make_shared<const RunLayer>(source.read(k)));
    predicted.push_back(*stream->next(1).front());
  }
  StackInfo frame = source.stack_info(StackKind::kPrinted);
  for (std::size_t axis = 0; axis < 2; ++axis) {
    frame.size[axis] *= job.grid.detail_vx[axis];
    frame.pitch_mm[axis] /= job.grid.detail_vx[axis];
  }
  for (const std::string& stack : stacks) {
    Measured measured = read_measured(stack, frame, predicted);
    std::vector<Shared<RunLayer>> layers;
    for (RunLayer& layer : measured.layers) {
      layers.push_back(std::make_shared<const RunLayer>(std::move(layer)));
    }
    job.prints.push_back(std::move(layers));
    progress.advance(++done);
  }
  return job;
}

void write_text(const fs::path& path, const std::string& text) {
  write_file(path.string(), std::as_bytes(std::span(text)));
}

std::string summary(const Calibration& calibration) {
  std::string text;
  if (calibration.effects.empty()) text = "nothing is missing that this print shows\n";
  for (const FoundEffect& effect : calibration.effects) {
    text += fmt::format(
        "{}: depends on {}{}{}, p {:.3f}\n",
        effect.kind == "empirical" ? "nothing in the catalogue explains this" : effect.kind,
        effect.covariate.axis, effect.covariate.form.empty() ? "" : ", ", effect.covariate.form,
        effect.p);
    for (const std::string& rival : effect.rivals) {
      text += fmt::format("  or {}: this part cannot tell\n", rival);
    }
  }
  for (const BeforeAfter& score : calibration.scores) {
    text += fmt::format("{}: wrong {:.4f} before, {:.4f} after", score.name, score.before.wrong,
                        score.after.wrong);
    if (score.floor) text += fmt::format("; two prints differ by {:.4f}", score.floor->wrong);
    text += "\n";
  }
  text.pop_back();
  return text;
}

void run(const CalibrateOptions& options, const Console& console) {
  if (options.check_job.empty() != options.check_measured.empty()) {
    throw Error(ErrorKind::kUsage, "--check-job", "goes together with --check-measured");
  }
  const Profile profile = load_profile(options.profile);
  std::vector<MeasuredJob> checks;
  const auto stacks = static_cast<int>(options.measured.size() + options.check_measured.size());
  constexpr int kSteps = 14;  // of a calibration with one effect; more only fill the bar
  Progress progress(console, "calibrating", stacks + kSteps);
  int done = 0;
  const MeasuredJob job =
      read_job(options.job, options.job, options.measured, profile, console, progress, done);
  if (!options.check_job.empty()) {
    checks.push_back(read_job(options.check_job, options.check_job, options.check_measured, profile,
                              console, progress, done));
  }
  const Calibration calibration =
      calibrate(job, checks, profile.effects, {}, [&](const std::string& what) {
        if (!console.quiet && !console.json) fmt::print(stderr, "{}\n", what);
        done = std::min(done + 1, stacks + kSteps - 1);
        progress.advance(done);
      });
  progress.advance(stacks + kSteps);

  const fs::path folder(options.out);
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw Error(ErrorKind::kBadInput, options.out, "cannot make the folder");
  const nlohmann::ordered_json json = calibration_json(calibration, "", "");
  write_text(folder / "calibration.json", json.dump(1) + "\n");
  console.result(json, summary(calibration));
}

}  // namespace

void add_calibrate_verb(CLI::App& program) {
  CLI::App* verb =
      program.add_subcommand("calibrate", "trace what a print lacks to effects of the model");
  auto options = std::make_shared<CalibrateOptions>();
  verb->add_option("-p,--profile", options->profile, "the printer as declared: a name or a path")
      ->required();
  verb->add_option("--job", options->job, "what was sent: a job (.bjob) or a folder of masks")
      ->required();
  verb->add_option("--measured", options->measured,
                   "what came out: a slice stack; again for each further print of the job")
      ->required();
  verb->add_option("--check-job", options->check_job,
                   "another job of the same printer, to judge the result on");
  verb->add_option("--check-measured", options->check_measured, "what came out of that one");
  verb->add_option("-o,--output", options->out, "the folder to write")->required();
  verb->callback([options, console = add_console_options(*verb)] { run(*options, *console); });
}

}  // namespace binderjet
