// SPDX-License-Identifier: GPL-3.0-or-later
// export JOB, -o DIR and FILEs: a job's layers as pictures and meshes that a person can open, as
// many kinds at once as are named.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <filesystem>
#include <initializer_list>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "driver/base/console.h"
#include "driver/base/files.h"
#include "driver/base/give_name.h"
#include "driver/export/demand_apart.h"
#include "driver/export/export_3mf.h"
#include "driver/export/export_cuberille.h"
#include "driver/export/export_stack.h"
#include "driver/export/export_zip.h"
#include "driver/job/mask_source.h"
#include "driver/job/parts.h"
#include "driver/job/print_stream.h"
#include "driver/verbs/verbs.h"
#include "driver/viewer/viewer.h"
#include "slicer/base/error.h"

namespace binderjet {
namespace {

struct ExportOptions {
  std::string job;
  std::string out;
  std::vector<std::string>
      what;  // of stack_words(); empty: masks, unless --separate asks for drops
  std::string cuberille;
  std::string html;
  std::string volume;  // --3mf
  std::string zip;
  std::string separate;
  bool full_bed = false;
};

// What can be written: stacks of images, in a folder, and single files.
enum class Output {
  kMasks,
  kColor,
  kTarget,
  kPrinted,
  kColorPlanes,
  kCuberille,
  kHtml,
  k3mf,
  kZip
};

const char* word(Output output) {
  switch (output) {
    case Output::kMasks:
      return "mask";
    case Output::kColor:
      return "color";
    case Output::kTarget:
      return "target";
    case Output::kPrinted:
      return "printed";
    case Output::kColorPlanes:
      return "cmy";
    case Output::kCuberille:
      return "cuberille";
    case Output::kHtml:
      return "html";
    case Output::k3mf:
      return "3mf";
    case Output::kZip:
      break;
  }
  return "zip";
}

constexpr std::array kStacks{Output::kMasks, Output::kColor, Output::kTarget, Output::kPrinted};

std::string folder_of(const MaskSource& job) {
  return std::filesystem::path(job.path).parent_path().string();
}

std::vector<std::string> stack_words() {
  std::vector<std::string> words;
  for (const Output stack : kStacks) words.emplace_back(word(stack));
  return words;
}

struct NamedOutput {
  Output output;
  std::string path;

  // The folders and files that stand there in the end.
  std::vector<std::string> paths() const {
    if (output != Output::kColorPlanes) return {path};
    std::vector<std::string> planes;
    for (const char* ink : kInks) planes.push_back(path + "/" + ink);
    return planes;
  }
};

// What goes into -o DIR: one stack is DIR itself, several are folders in it, of their words.
std::vector<NamedOutput> stacks(const ExportOptions& options) {
  std::vector<Output> kinds;
  for (const Output stack : kStacks) {
    const auto& what = options.what;
    if (std::find(what.begin(), what.end(), word(stack)) != what.end()) kinds.push_back(stack);
  }
  const bool planes = !options.separate.empty();
  if (kinds.empty() && !planes) kinds.push_back(Output::kMasks);
  const bool alone = kinds.size() == 1 && !planes;
  std::vector<NamedOutput> named;
  for (const Output kind : kinds) {
    const std::filesystem::path folder(options.out);
    named.push_back({kind, alone ? options.out : (folder / word(kind)).string()});
  }
  if (planes) named.push_back({Output::kColorPlanes, options.out});
  return named;
}

// All that the command line names to write.
std::vector<NamedOutput> outputs_of(const ExportOptions& options) {
  if (options.out.empty() && !options.separate.empty()) {
    throw Error(ErrorKind::kUsage, "--separate", "needs a folder, -o DIR");
  }
  if (options.out.empty() && !options.what.empty()) {
    throw Error(ErrorKind::kUsage, "--what", "needs a folder, -o DIR");
  }
  std::vector<NamedOutput> named;
  if (!options.out.empty()) named = stacks(options);
  for (const NamedOutput& each :
       {NamedOutput{Output::kCuberille, options.cuberille},
        NamedOutput{Output::kHtml, options.html}, NamedOutput{Output::k3mf, options.volume},
        NamedOutput{Output::kZip, options.zip}}) {
    if (!each.path.empty()) named.push_back(each);
  }
  if (named.empty()) {
    throw Error(ErrorKind::kUsage, "export",
                "name what to write: -o DIR, --html FILE, --3mf FILE, --zip FILE or --cuberille "
                "FILE.ply");
  }
  return named;
}

bool writes(const std::vector<NamedOutput>& outputs, std::initializer_list<Output> any) {
  return std::any_of(outputs.begin(), outputs.end(), [&](const NamedOutput& one) {
    return std::find(any.begin(), any.end(), one.output) != any.end();
  });
}

// What can be known to be wrong before anything is written.
void check_outputs(const std::vector<NamedOutput>& outputs, const ExportOptions& options,
                   const MaskSource& job) {
  if (options.full_bed && !writes(outputs, {Output::kMasks, Output::kZip})) {
    throw Error(ErrorKind::kUsage, "--full-bed", "is for masks only");
  }
  if (writes(outputs, {Output::kColor, Output::kColorPlanes})) demand_color(job);
  std::vector<std::string> paths;
  for (const NamedOutput& one : outputs) {
    for (const std::string& path : one.paths()) paths.push_back(path);
  }
  std::vector<std::string> inputs = part_files(*job.header, folder_of(job));
  inputs.push_back(options.job);
  demand_apart(paths, inputs);
}

// The job's models as one, read once for all outputs that show the target. A page goes without if
// they are gone.
std::shared_ptr<const Mesh> target_of(const std::vector<NamedOutput>& outputs,
                                      const MaskSource& job, const Console& console) {
  const bool must = writes(outputs, {Output::kTarget});
  if (!must && !writes(outputs, {Output::kHtml})) return nullptr;
  try {
    return reload_parts(*job.header, folder_of(job), console.work());
  } catch (const Error& error) {
    if (must || error.kind() != ErrorKind::kBadInput) throw;
    console.warning(fmt::format("{}; the page goes without the target", error.what()));
    return nullptr;
  }
}

GiveName write(const MaskSource& job, const std::shared_ptr<const Mesh>& target,
               const NamedOutput& named, bool full_bed, const Work& work) {
  const std::string& path = named.path;
  const JobHeader& header = *job.header;
  switch (named.output) {
    case Output::kMasks:
      return export_masks(job, path, full_bed, work);
    case Output::kColor:
      return export_color(job, path, work);
    case Output::kTarget:
      return export_target(job, target, path, work);
    case Output::kPrinted:
      return write_printed(job, PrinterModel(header.profile.effects, header.grid, job.place()),
                           header.grid, path, work);
    case Output::kColorPlanes:
      return export_planes(job, path, work);
    case Output::kCuberille:
      return export_cuberille(job, path, work);
    case Output::kHtml:
      return write_unnamed({path, viewer_page(job, target, work)});
    case Output::k3mf:
      return export_3mf(job, path, work);
    case Output::kZip:
      break;
  }
  return export_zip(job, path, full_bed, work);
}

void run(const ExportOptions& options, const Console& console) {
  const std::vector<NamedOutput> outputs = outputs_of(options);
  const MaskSource job = open_job(options.job, console);
  check_outputs(outputs, options, job);
  const auto target = target_of(outputs, job, console);
  std::vector<GiveName> written;
  for (const NamedOutput& one : outputs) {
    written.push_back(write(job, target, one, options.full_bed, console.work()));
  }
  for (const GiveName& give_name : written) give_name();

  const int layers = job.size_px[2];
  nlohmann::ordered_json json;
  std::string text;
  for (const NamedOutput& one : outputs) {
    json["outputs"].push_back({{"out", one.path}, {"what", word(one.output)}});
    text += fmt::format("{}{}: {} layers", text.empty() ? "" : "\n", one.path, layers);
  }
  if (outputs.size() == 1) json.update(nlohmann::ordered_json(json["outputs"].front()));
  json["layers"] = layers;
  console.result(json, text);
}

}  // namespace

void add_export_verb(CLI::App& program) {
  CLI::App* verb = program.add_subcommand("export", "write a job's layers as pictures or a mesh");
  auto options = std::make_shared<ExportOptions>();
  verb->add_option("JOB", options->job, "a job (.bjob)")->required();
  verb->add_option("-o,--output", options->out,
                   "the folder to write: stack.json and PNGs; several stacks get folders in it, "
                   "named as in --what");
  verb->add_option("--what", options->what,
                   "mask: what is sent; color: its color; target: the voxels we want; printed: "
                   "what the model says comes out; several with commas, or the option again")
      ->check(CLI::IsMember(stack_words()))
      ->delimiter(',')
      ->allow_extra_args(false)
      ->default_str(word(Output::kMasks));
  verb->add_option("--separate", options->separate,
                   "cmy: the color as 1-bit planes, in the folders cyan, magenta and yellow")
      ->check(CLI::IsMember({"cmy"}));
  verb->add_flag("--full-bed", options->full_bed, "masks of the whole bed, the part in its place");
  verb->add_option("--cuberille", options->cuberille,
                   "write the masks' voxels as a PLY mesh (the paper's own output)");
  verb->add_option("--html", options->html,
                   "write one page with all layers side by side, for any browser, offline");
  verb->add_option("--3mf", options->volume,
                   "write masks and color as a 3MF with a volumetric image stack");
  verb->add_option("--zip", options->zip,
                   "write masks as numbered PNGs in a ZIP, for UVtools and NanoDLP");
  verb->callback([options, console = add_console_options(*verb)] { run(*options, *console); });
}

}  // namespace binderjet
