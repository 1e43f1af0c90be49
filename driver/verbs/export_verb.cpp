// SPDX-License-Identifier: GPL-3.0-or-later
// export JOB -o DIR: a job's layers as pictures that a person can open.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <string>
#include <vector>

#include "driver/base/console.h"
#include "driver/base/files.h"
#include "driver/export/export_3mf.h"
#include "driver/export/export_stack.h"
#include "driver/export/export_zip.h"
#include "driver/job/mask_source.h"
#include "driver/job/print_stream.h"
#include "driver/verbs/verbs.h"
#include "driver/viewer/viewer.h"
#include "slicer/base/error.h"
#include "slicer/stack/cuberille.h"

namespace binderjet {
namespace {

struct ExportOptions {
  std::string job;
  std::string out;
  std::string what = "mask";
  std::string cuberille;
  std::string html;
  std::string volume;  // --3mf
  std::string zip;
  std::string separate;
  bool full_bed = false;
};

void export_cuberille(const MaskSource& job, const std::string& path, const Console& console) {
  CuberilleWriter writer(path, job.header->grid);
  Progress progress(console, "writing", job.size_px[2]);
  for (int index = 0; index < job.size_px[2]; ++index) {
    writer.add(job.read(index));
    progress.advance(index + 1);
  }
  writer.finish();
}

struct Output {
  std::string what;
  std::string path;
};

// The one place that the command line names to write to.
Output only_output(const ExportOptions& options) {
  const std::string stack = options.separate.empty() ? options.what : options.separate;
  std::vector<Output> named;
  for (const Output& output :
       {Output{stack, options.out}, Output{"cuberille", options.cuberille},
        Output{"html", options.html}, Output{"3mf", options.volume}, Output{"zip", options.zip}}) {
    if (!output.path.empty()) named.push_back(output);
  }
  if (named.size() != 1) {
    throw Error(ErrorKind::kUsage, "export",
                "name one of -o DIR, --html FILE, --3mf FILE, --zip FILE and --cuberille FILE.ply");
  }
  return named.front();
}

void run(const ExportOptions& options, const Console& console) {
  const Output output = only_output(options);
  if (!options.separate.empty() && options.out.empty()) {
    throw Error(ErrorKind::kUsage, "--separate", "needs a folder, -o DIR");
  }
  if (options.full_bed && output.what != "mask" && output.what != "zip") {
    throw Error(ErrorKind::kUsage, "--full-bed", "is for masks only");
  }
  const MaskSource job = open_job(options.job, console);
  if (output.what == "cuberille") {
    export_cuberille(job, output.path, console);
  } else if (output.what == "html") {
    write_text(output.path, viewer_page(job, console));
  } else if (output.what == "3mf") {
    export_3mf(job, output.path, console);
  } else if (output.what == "zip") {
    export_zip(job, output.path, options.full_bed, console);
  } else if (output.what == "cmy") {
    export_planes(job, output.path, console);
  } else if (output.what == "color") {
    export_color(job, output.path, console);
  } else if (output.what == "mask") {
    export_masks(job, output.path, options.full_bed, console);
  } else if (output.what == "target") {
    export_target(job, output.path, console);
  } else {
    write_printed(job, PrinterModel(job.header->profile.effects, job.header->grid, job.place()),
                  job.header->grid, output.path, console);
  }
  console.result({{"out", output.path}, {"what", output.what}, {"layers", job.size_px[2]}},
                 fmt::format("{}: {} layers", output.path, job.size_px[2]));
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
      ->check(CLI::IsMember({"mask", "color", "target", "printed"}))
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
