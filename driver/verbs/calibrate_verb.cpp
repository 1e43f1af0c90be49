// SPDX-License-Identifier: GPL-3.0-or-later
// calibrate -p PROFILE, --job JOB --measured STACK... or --gauges FILE, -o DIR: the residual of a
// profile's model, traced to the effects that it lacks.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "driver/base/console.h"
#include "driver/base/files.h"
#include "driver/base/json_text.h"
#include "driver/job/mask_source.h"
#include "driver/job/mesh_scan_to_stack.h"
#include "driver/job/print_stream.h"
#include "driver/profile/write_profile.h"
#include "driver/report/calibrate_gauges.h"
#include "driver/report/calibration_json.h"
#include "driver/report/calibration_report.h"
#include "driver/verbs/verbs.h"
#include "slicer/base/error.h"
#include "slicer/base/whole_file.h"
#include "slicer/calibrate/calibrate.h"
#include "slicer/calibrate/scan/measured.h"

namespace binderjet {
namespace {

namespace fs = std::filesystem;

struct CalibrateOptions {
  std::string profile;
  std::string job;
  std::vector<std::string> measured;
  std::string check_job;
  std::vector<std::string> check_measured;
  std::string gauges;
  std::string out;
};

// The masks of a job and what was measured of it, registered to what the profile predicts.
MeasuredJob read_job(const std::string& name, const std::string& path,
                     const std::vector<std::string>& stacks, const Profile& profile,
                     const std::string& folder, const Console& console) {
  const MaskSource source = open_masks(path, console);
  MeasuredJob job;
  job.name = name;
  job.grid = {source.pitch_mm, profile.detail_vx};
  job.place = source.place();
  job.first_layer = source.first;
  job.work = console.work();
  const PrinterModel model(profile.effects, job.grid, job.place);
  std::vector<RunLayer> predicted;
  {
    Stage stage(job.work, "predicting", source.size_px[2], "layers");
    const auto stream = printed_stream(source, model, job.work);
    for (int k = 0; k < source.size_px[2]; ++k) {
      job.masks.push_back(std::make_shared<const RunLayer>(source.read(k)));
      predicted.push_back(*stream->next(1).front());
      stage.advance();
    }
  }
  StackInfo frame = source.stack_info(StackKind::kPrinted);
  for (std::size_t axis = 0; axis < 2; ++axis) {
    frame.size[axis] *= job.grid.detail_vx[axis];
    frame.pitch_mm[axis] /= job.grid.detail_vx[axis];
  }
  for (const std::string& path_of_scan : stacks) {
    std::string stack = path_of_scan;
    if (fs::is_regular_file(stack)) {  // a mesh
      stack = fmt::format("{}/{}.slices", folder, fs::path(path_of_scan).filename().string());
      write_scan_stack(path_of_scan, job.grid.pitch_mm[2], stack, job.work);
    }
    Measured measured = read_measured(stack, frame, predicted, job.work);
    job.scanned = job.scanned || measured.registration.has_value();
    std::vector<Shared<RunLayer>> layers;
    for (RunLayer& layer : measured.layers) {
      layers.push_back(std::make_shared<const RunLayer>(std::move(layer)));
    }
    job.prints.push_back(std::move(layers));
  }
  return job;
}

std::string summary(const Calibration& calibration) {
  std::string text;
  if (calibration.verdict == Verdict::kNone) text = "nothing is missing that this print shows\n";
  if (calibration.verdict == Verdict::kUnexplained && calibration.effects.empty()) {
    text = "the print is not as predicted, and nothing that was tried explains it\n";
  }
  for (const FoundEffect& effect : calibration.effects) {
    text += fmt::format("{}: depends on {}{}{}, p {:.3f}\n",
                        effect.named ? effect.kind : "nothing in the catalogue explains this",
                        word(effect.covariate.axis),
                        effect.covariate.form == Covariate::Form::kConstant ? "" : ", ",
                        word(effect.covariate.form), effect.p);
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

// The profile with the effects found, and where they come from.
std::string calibrated_text(const Calibration& calibration, const Profile& declared,
                            const CalibrateOptions& options) {
  std::vector<std::string> notes = {fmt::format(
      "Calibrated by binderjet {} on {} ({} print{}); declared: {} ({}).", BINDERJET_VERSION,
      options.job, options.measured.size(), options.measured.size() == 1 ? "" : "s", declared.name,
      text_hash(declared.text))};
  for (const FoundEffect& effect : calibration.effects) {
    notes.push_back(fmt::format("{}: {}, p {:.3f}, held-out gain {:.0f} %{}{}.", effect.kind,
                                text_of(effect.covariate), effect.p, 100 * effect.heldout_gain,
                                effect.rivals.empty() ? "" : "; could also be ",
                                fmt::join(effect.rivals, ", ")));
  }
  for (const BeforeAfter& score : calibration.scores) {
    notes.push_back(fmt::format("{}: wrong {:.4f} before, {:.4f} after.", score.name,
                                score.before.wrong, score.after.wrong));
  }
  return calibrated_profile(declared, declared.name + " calibrated",
                            declared.source + "; calibrated on " + options.job, notes,
                            calibration.after_model);
}

void run(const CalibrateOptions& options, const Console& console) {
  if (options.gauges.empty() && (options.job.empty() || options.measured.empty())) {
    throw Error(ErrorKind::kUsage, "calibrate", "needs --job and --measured, or --gauges");
  }
  if (!options.gauges.empty()) {
    if (!options.job.empty() || !options.measured.empty() || !options.check_job.empty()) {
      throw Error(ErrorKind::kUsage, "--gauges", "stands alone, without --job and --measured");
    }
    calibrate_gauges(options.profile, options.gauges, options.out, console);
    return;
  }
  if (options.check_job.empty() != options.check_measured.empty()) {
    throw Error(ErrorKind::kUsage, "--check-job", "goes together with --check-measured");
  }
  const fs::path folder(options.out);
  const OutputFolder out(options.out);
  const Profile profile = load_profile(options.profile);
  std::vector<MeasuredJob> checks;
  const MeasuredJob job =
      read_job(options.job, options.job, options.measured, profile, options.out, console);
  if (!options.check_job.empty()) {
    checks.push_back(read_job(options.check_job, options.check_job, options.check_measured, profile,
                              options.out, console));
  }
  const Calibration calibration = calibrate(job, checks, profile.effects, {});

  std::string written;
  std::vector<TextFile> files;
  if (!calibration.effects.empty()) {
    written = calibrated_file_name(profile);
    files.push_back({(folder / written).string(), calibrated_text(calibration, profile, options)});
  }
  const std::string title = "Calibration of " + profile.name + " on " + options.job;
  files.push_back({(folder / "report.html").string(), calibration_report(calibration, job, title)});
  const nlohmann::ordered_json json = calibration_json(calibration, written, "report.html");
  files.push_back({(folder / "calibration.json").string(), to_json_text(json, 1) + "\n"});
  write_texts(files);
  std::string text = summary(calibration);
  if (!written.empty()) text += "\nprofile: " + (folder / written).string();
  console.result(json, text + "\nreport: " + (folder / "report.html").string());
}

}  // namespace

void add_calibrate_verb(CLI::App& program) {
  CLI::App* verb =
      program.add_subcommand("calibrate", "trace what a print lacks to effects of the model");
  auto options = std::make_shared<CalibrateOptions>();
  verb->add_option("-p,--profile", options->profile, "the printer as declared: a name or a path")
      ->required();
  verb->add_option("--job", options->job, "what was sent: a job (.bjob) or a folder of masks");
  verb->add_option("--measured", options->measured,
                   "what came out: a slice stack or the mesh of a scan; again for each further "
                   "print of the job");
  verb->add_option("--check-job", options->check_job,
                   "another job of the same printer, to judge the result on");
  verb->add_option("--check-measured", options->check_measured, "what came out of that one");
  verb->add_option("--gauges", options->gauges,
                   "or a table (CSV) of slots, walls or lengths that were measured");
  verb->add_option("-o,--output", options->out, "the folder to write")->required();
  verb->callback([options, console = add_console_options(*verb)] { run(*options, *console); });
}

}  // namespace binderjet
