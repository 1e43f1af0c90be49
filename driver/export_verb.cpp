// SPDX-License-Identifier: GPL-3.0-or-later
// export JOB -o DIR: a job's layers as pictures that a person can open.
#include <fmt/format.h>
#include <oneapi/tbb/parallel_for.h>

#include <CLI/CLI.hpp>
#include <array>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "driver/console.h"
#include "driver/files.h"
#include "driver/mask_source.h"
#include "driver/printed.h"
#include "driver/verbs.h"
#include "driver/viewer.h"
#include "slicer/color/separate.h"
#include "slicer/error.h"
#include "slicer/stack/cuberille.h"
#include "slicer/stack/slice_stack.h"
#include "slicer/voxelize.h"

namespace binderjet {
namespace {

struct ExportOptions {
  std::string job;
  std::string out;
  std::string what = "mask";
  std::string cuberille;
  std::string html;
  std::string separate;
  bool full_bed = false;
};

// Runs work(index) for index in [0, count) on all cores, in blocks between which progress is told
// and Ctrl-C is heard.
template <class Work>
void for_each_layer(int count, Progress& progress, Work work) {
  constexpr int kBlock = 4 * kBlockLayers;
  for (int first = 0; first < count; first += kBlock) {
    const int last = std::min(count, first + kBlock);
    oneapi::tbb::parallel_for(first, last, work);
    progress.advance(last);
  }
}

void export_masks(const MaskSource& job, const ExportOptions& options, const Console& console) {
  const JobHeader& header = *job.header;
  StackInfo info = job.stack_info(StackKind::kMask);
  if (options.full_bed) {
    for (std::size_t axis = 0; axis < 2; ++axis) {
      info.size[axis] = header.profile.bed(header.grid).pixels(static_cast<int>(axis));
      info.origin_mm[axis] = 0;
    }
  }
  StackWriter stack(options.out, info);
  Progress progress(console, "writing", info.size[2]);
  for_each_layer(info.size[2], progress, [&](int index) {
    if (options.full_bed) {
      stack.write(index, window(job.read(index), -header.box.bed_px[0], -header.box.bed_px[1],
                                info.size[0], info.size[1]));
    } else {
      stack.write_packed(index, job.packed(index));
    }
  });
  stack.finish();
}

void export_target(const MaskSource& job, const ExportOptions& options, const Console& console) {
  const JobHeader& header = *job.header;
  const int rz = header.grid.detail_vx[2];
  StackInfo info = job.stack_info(StackKind::kTarget);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    info.size[axis] *= header.grid.detail_vx[axis];
    info.pitch_mm[axis] = header.grid.voxel_mm(static_cast<int>(axis));
  }
  info.first *= rz;
  const auto mesh = reload_parts(header, std::filesystem::path(job.path).parent_path().string());
  const auto target = voxelize(mesh, header.grid, header.box, job.layers());

  StackWriter stack(options.out, info);
  Progress progress(console, "writing", job.size_px[2]);
  int done = 0;
  while (target->rest().size() > 0) {
    const auto block = target->next(kBlockLayers);
    oneapi::tbb::parallel_for(0, static_cast<int>(block.size()) * rz, [&](int s) {
      stack.write(
          done * rz + s,
          block[static_cast<std::size_t>(s / rz)]->slices[static_cast<std::size_t>(s % rz)]);
    });
    done += static_cast<int>(block.size());
    progress.advance(done);
  }
  stack.finish();
}

void export_color(const MaskSource& job, const ExportOptions& options, const Console& console) {
  if (!job.color) {
    throw Error(ErrorKind::kUsage, job.path,
                "has no color; its models had none when it was sliced");
  }
  StackWriter stack(options.out, job.stack_info(StackKind::kColor));
  Progress progress(console, "writing", job.size_px[2]);
  for_each_layer(job.size_px[2], progress,
                 [&](int index) { stack.write_rgb(index, job.color(index)); });
  stack.finish();
}

// Three stacks of drops: cyan, magenta and yellow, each in a folder of its name.
void export_planes(const MaskSource& job, const ExportOptions& options, const Console& console) {
  if (!job.color) {
    throw Error(ErrorKind::kUsage, job.path,
                "has no color; its models had none when it was sliced");
  }
  constexpr std::array<const char*, 3> kInks = {"cyan", "magenta", "yellow"};
  std::vector<std::unique_ptr<StackWriter>> stacks;
  for (const char* ink : kInks) {
    StackInfo info = job.stack_info(StackKind::kColor);
    info.files = std::string(ink) + "_%06d.png";
    stacks.push_back(std::make_unique<StackWriter>(options.out + "/" + ink, info));
  }
  Progress progress(console, "writing", job.size_px[2]);
  for_each_layer(job.size_px[2], progress, [&](int index) {
    std::vector<std::byte> rgb = job.color(index);
    whiten_outside(job.read(index), rgb);
    const std::array<RunLayer, 3> planes =
        separate_cmy(rgb, job.size_px[0], job.size_px[1], job.first + index);
    for (std::size_t c = 0; c < 3; ++c) stacks[c]->write(index, planes[c]);
  });
  for (const auto& stack : stacks) stack->finish();
}

void export_cuberille(const MaskSource& job, const std::string& path, const Console& console) {
  CuberilleWriter writer(path, job.header->grid);
  Progress progress(console, "writing", job.size_px[2]);
  for (int index = 0; index < job.size_px[2]; ++index) {
    writer.add(job.read(index));
    progress.advance(index + 1);
  }
  writer.finish();
}

void run(const ExportOptions& options, const Console& console) {
  const MaskSource job = open_job(options.job, console);
  if (!options.out.empty() + !options.cuberille.empty() + !options.html.empty() != 1) {
    throw Error(ErrorKind::kUsage, "export",
                "name one of -o DIR, --html FILE and --cuberille FILE.ply");
  }
  if (!options.separate.empty() && options.out.empty()) {
    throw Error(ErrorKind::kUsage, "--separate", "needs a folder, -o DIR");
  }
  if (options.full_bed &&
      (options.what != "mask" || options.out.empty() || !options.separate.empty())) {
    throw Error(ErrorKind::kUsage, "--full-bed", "is for masks only");
  }
  if (!options.cuberille.empty()) {
    export_cuberille(job, options.cuberille, console);
  } else if (!options.html.empty()) {
    write_text(options.html, viewer_page(job, console));
  } else if (!options.separate.empty()) {
    export_planes(job, options, console);
  } else if (options.what == "color") {
    export_color(job, options, console);
  } else if (options.what == "mask") {
    export_masks(job, options, console);
  } else if (options.what == "target") {
    export_target(job, options, console);
  } else {
    write_printed(job, PrinterModel(job.header->profile.effects, job.header->grid, job.place()),
                  job.header->grid, options.out, console);
  }
  const std::string out = options.out + options.cuberille + options.html;
  std::string what = options.separate.empty() ? options.what : options.separate;
  if (!options.cuberille.empty()) what = "cuberille";
  if (!options.html.empty()) what = "html";
  console.result({{"out", out}, {"what", what}, {"layers", job.size_px[2]}},
                 fmt::format("{}: {} layers", out, job.size_px[2]));
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
  verb->callback([options, console = add_console_options(*verb)] { run(*options, *console); });
}

}  // namespace binderjet
