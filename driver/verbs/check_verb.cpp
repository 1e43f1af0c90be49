// SPDX-License-Identifier: GPL-3.0-or-later
// check PART... -p PROFILE, or check JOB: what a print would lose, fuse and trap, before any powder
// is spent.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <bit>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "driver/job/estimate.h"
#include "driver/job/mask_source.h"
#include "driver/job/parts.h"
#include "driver/job/print_stream.h"
#include "driver/job/slice_plan.h"
#include "driver/report/findings.h"
#include "driver/verbs/verbs.h"
#include "slicer/base/error.h"
#include "slicer/model/printer_model.h"
#include "slicer/score/score.h"
#include "slicer/score/thin_places.h"
#include "slicer/voxels/voxelize.h"

namespace binderjet {
namespace {

using Json = nlohmann::ordered_json;

// What is checked, whether it is sliced for that or read from a job.
struct Print {
  JobHeader header;
  std::shared_ptr<const Mesh> mesh;
  LayerRange layers;
  std::unique_ptr<Stream<RunLayer>> printed;
  std::shared_ptr<MaskTally> tally;  // of the masks, as they pass
  std::vector<std::string> warnings;
  bool doubtful_size = false;
};

Print print_of_parts(const SliceOptions& options, const Console& console) {
  if (options.profile.empty()) {
    throw Error(ErrorKind::kUsage, "check", "needs a printer for models: -p PROFILE");
  }
  SlicePlan plan = plan_slices(options, console);
  Print print;
  const auto model = std::make_shared<const PrinterModel>(
      plan.header.profile.effects, plan.header.grid, place_of(plan.header.box, plan.header.grid));
  print.tally = std::make_shared<MaskTally>();
  print.printed =
      printed_job(plan.header, plan.mesh, model, print.tally, console.work()).all_layers();
  print.layers = {0, plan.header.layers()};
  print.header = std::move(plan.header);
  print.mesh = std::move(plan.mesh);
  print.warnings = std::move(plan.warnings);
  print.doubtful_size = plan.doubtful_size;
  return print;
}

// The masks of a job, whose pixels are counted as they are read.
MaskSource counted(MaskSource job, std::shared_ptr<MaskTally> tally) {
  job.packed = [packed = std::move(job.packed), tally = std::move(tally)](int index) {
    std::vector<std::byte> bits = packed(index);
    for (const std::byte byte : bits) {
      tally->pixels += std::popcount(std::to_integer<unsigned char>(byte));
    }
    return bits;
  };
  return job;
}

// Nothing is sliced: the job's masks are printed as they are, by its own printer or by another.
// `job` and `model` must outlive the print.
Print print_of_job(const MaskSource& job, const PrinterModel& model, const JobHeader& header,
                   std::shared_ptr<MaskTally> tally, const Console& console) {
  Print print;
  print.header = header;
  print.mesh =
      reload_parts(header, std::filesystem::path(job.path).parent_path().string(), console.work());
  print.layers = job.layers();
  print.printed = printed_stream(job, model, console.work());
  print.tally = std::move(tally);
  if (print.layers != LayerRange{0, header.layers()}) {
    print.warnings.push_back(fmt::format(
        "{}: holds layers {} to {} of {}; nothing is said of the others, and what is cut "
        "there may look loose",
        job.path, print.layers.first, print.layers.last - 1, header.layers()));
    console.warning(print.warnings.back());
  }
  return print;
}

// Places of the target below a rule of [strength], those within the layers that are checked. All
// of the target is looked at: the cut end of a share is no thin place.
std::optional<ThinPlaces> below_rule(const char* key, std::optional<double> rule_mm, Matter matter,
                                     Print& print, const Console& console) {
  if (!rule_mm) return std::nullopt;
  const JobHeader& header = print.header;
  const double least_mm = least_rule_mm(header.grid);
  if (*rule_mm < least_mm) {
    print.warnings.push_back(fmt::format(
        "[strength] {} = {:g} is not looked at: this grid cannot tell less than {:.2f} mm, "
        "three of its coarsest voxels or layers; take a finer layer, or leave the key out",
        key, *rule_mm, least_mm));
    console.warning(print.warnings.back());
    return std::nullopt;
  }
  const int rz = header.grid.detail_vx[2];
  ThinPlaces places;
  find_thin_places(voxel_layers(print.mesh, header.grid, header.box, console.work()), header.grid,
                   *rule_mm, matter, console.work(), [&](const ThinPlace& place) {
                     if (place.region.low[2] < print.layers.last * rz &&
                         place.region.high[2] > print.layers.first * rz) {
                       places.add(place);
                     }
                   });
  return places;
}

std::string verdict_on(const Findings& findings, bool doubtful_size) {
  if (findings.score().voxels.solid == 0) return "nothing to print";
  if (doubtful_size) return "doubtful size";
  return findings.verdict();
}

void check(Print print, const Console& console) {
  const JobHeader& header = print.header;
  Findings findings(header.grid, header.origin_mm(), print.layers.first);
  {
    const auto layers =
        score_layers(voxelize(print.mesh, header.grid, header.box,
                              target_around(print.layers, header.grid, header.layers())),
                     std::move(print.printed), header.grid, print.layers);
    Stage stage(console.work(), "checking", print.layers.size(), "layers");
    while (layers->rest().size() > 0) {
      for (const Shared<LayerScore>& layer : layers->next(kBlockLayers)) findings.add(*layer);
      stage.reach(layers->rest().first - print.layers.first);
    }
  }
  const StrengthRules& strength = header.profile.strength;
  findings.set_thin(below_rule("thinnest_mm", strength.thinnest_mm, Matter::kPart, print, console));
  findings.set_narrow(
      below_rule("narrowest_mm", strength.narrowest_mm, Matter::kPowder, print, console));
  findings.finish();
  const VoxelCounts& voxels = findings.score().voxels;
  Totals totals;
  totals.layers = print.layers.size();
  totals.mask_px = print.tally->pixels;
  totals.target_vx = voxels.solid;
  totals.rules = print.tally->rules;
  const std::string changed = rule_warning(totals.rules, header.profile.mask);
  if (!changed.empty()) {
    console.warning(changed);
    print.warnings.push_back(changed);
  }
  const std::string verdict = verdict_on(findings, print.doubtful_size);
  const Estimate estimate = estimate_of(header, totals);
  Json json = {{"verdict", verdict}};
  json.update(findings.to_json());
  json["excess"] = voxels.excess();
  json["print_minutes"] = estimate.print_minutes;
  json["binder_ml"] = estimate.binder_ml;
  json["powder_ml"] = estimate.powder_ml;
  json["warnings"] = print.warnings;
  const std::string text = fmt::format(
      "{}{:.2f} % of the part's voxels will be wrong beyond the layers' height\n{}\nverdict: {}",
      findings.text(), 100 * voxels.excess(), text_of(estimate, header), verdict);
  console.result(json, text);
}

bool is_job(const std::string& file) { return std::filesystem::path(file).extension() == ".bjob"; }

// What says how to slice has nothing to say of a job.
void refuse_slice_options(const CLI::App& verb, const std::string& job) {
  constexpr std::array<std::string_view, 5> kOfAJob{"PART", "--profile", "--json", "--quiet",
                                                    "--help"};
  for (const CLI::Option* option : verb.get_options()) {
    const std::string name = option->get_name();
    if (option->count() == 0 || std::find(kOfAJob.begin(), kOfAJob.end(), name) != kOfAJob.end()) {
      continue;
    }
    throw Error(ErrorKind::kUsage, name,
                fmt::format("is for models; {} is sliced already, slice it again", job));
  }
}

void run(const SliceOptions& options, const CLI::App& verb, const Console& console) {
  if (std::none_of(options.parts.begin(), options.parts.end(), is_job)) {
    check(print_of_parts(options, console), console);
    return;
  }
  if (options.parts.size() > 1) {
    throw Error(ErrorKind::kUsage, "check", "takes one job, or models; not both");
  }
  refuse_slice_options(verb, options.parts.front());
  const auto tally = std::make_shared<MaskTally>();
  const MaskSource job = counted(open_job(options.parts.front(), console), tally);
  JobHeader header = *job.header;
  if (!options.profile.empty()) header.profile = load_profile(options.profile);
  const PrinterModel model(header.profile.effects, header.grid, job.place());
  check(print_of_job(job, model, header, tally, console), console);
}

}  // namespace

void add_check_verb(CLI::App& program) {
  CLI::App* verb = program.add_subcommand(
      "check", "say what a print would lose, fuse and trap, before any powder is spent");
  auto options = std::make_shared<SliceOptions>();
  verb->add_option("PART", options->parts,
                   "models: STL, PLY, OBJ, OFF, 3MF, glTF and others; or a job (.bjob), which is "
                   "not sliced again")
      ->required();
  verb->add_option("-p,--profile", options->profile,
                   "a printer profile's name or path; for a job, another printer than its own");
  add_slice_options(*verb, *options);
  verb->callback(
      [options, verb, console = add_console_options(*verb)] { run(*options, *verb, *console); });
}

}  // namespace binderjet
