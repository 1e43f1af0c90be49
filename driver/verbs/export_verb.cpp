// SPDX-License-Identifier: GPL-3.0-or-later
// export JOB -o DIR: a job's layers as pictures that a person can open.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "driver/base/console.h"
#include "driver/base/files.h"
#include "driver/base/give_name.h"
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
  std::string what = "mask";  // one of stack_words()
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

std::vector<std::string> stack_words() {
  std::vector<std::string> words;
  for (const Output stack : kStacks) words.emplace_back(word(stack));
  return words;
}

Output stack_of(const ExportOptions& options) {
  if (!options.separate.empty()) return Output::kColorPlanes;
  return *std::find_if(kStacks.begin(), kStacks.end(),
                       [&](Output stack) { return options.what == word(stack); });
}

struct NamedOutput {
  Output output;
  std::string path;
};

// The one place that the command line names to write to.
NamedOutput only_output(const ExportOptions& options) {
  std::vector<NamedOutput> named;
  for (const NamedOutput& each :
       {NamedOutput{stack_of(options), options.out},
        NamedOutput{Output::kCuberille, options.cuberille},
        NamedOutput{Output::kHtml, options.html}, NamedOutput{Output::k3mf, options.volume},
        NamedOutput{Output::kZip, options.zip}}) {
    if (!each.path.empty()) named.push_back(each);
  }
  if (named.size() != 1) {
    throw Error(ErrorKind::kUsage, "export",
                "name one of -o DIR, --html FILE, --3mf FILE, --zip FILE and --cuberille FILE.ply");
  }
  return named.front();
}

// The job's models as one; a page goes without if they are gone.
std::shared_ptr<const Mesh> target_of(Output output, const MaskSource& job,
                                      const Console& console) {
  if (output != Output::kTarget && output != Output::kHtml) return nullptr;
  try {
    return reload_parts(*job.header, std::filesystem::path(job.path).parent_path().string(),
                        console.work());
  } catch (const Error& error) {
    if (output == Output::kTarget || error.kind() != ErrorKind::kBadInput) throw;
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
  const NamedOutput named = only_output(options);
  if (!options.separate.empty() && options.out.empty()) {
    throw Error(ErrorKind::kUsage, "--separate", "needs a folder, -o DIR");
  }
  if (options.full_bed && named.output != Output::kMasks && named.output != Output::kZip) {
    throw Error(ErrorKind::kUsage, "--full-bed", "is for masks only");
  }
  const MaskSource job = open_job(options.job, console);
  const auto target = target_of(named.output, job, console);
  write(job, target, named, options.full_bed, console.work())();
  console.result({{"out", named.path}, {"what", word(named.output)}, {"layers", job.size_px[2]}},
                 fmt::format("{}: {} layers", named.path, job.size_px[2]));
}

}  // namespace

void add_export_verb(CLI::App& program) {
  CLI::App* verb = program.add_subcommand("export", "write a job's layers as pictures or a mesh");
  auto options = std::make_shared<ExportOptions>();
  verb->add_option("JOB", options->job, "a job (.bjob)")->required();
  verb->add_option("-o,--output", options->out, "the folder to write: stack.json and PNGs");
  verb->add_option("--what", options->what,
                   "mask: what is sent; color: its color; target: the voxels we want; printed: "
                   "what the model "
                   "says comes out")
      ->check(CLI::IsMember(stack_words()))
      ->capture_default_str();
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
