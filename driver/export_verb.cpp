// SPDX-License-Identifier: GPL-3.0-or-later
// export JOB -o DIR: a job's layers as pictures that a person can open.
#include <fmt/format.h>
#include <oneapi/tbb/parallel_for.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "driver/console.h"
#include "driver/job.h"
#include "driver/result.h"
#include "driver/verbs.h"
#include "slicer/cuberille.h"
#include "slicer/slice_stack.h"
#include "slicer/voxelize.h"
#include "transport/job_file.h"

namespace binderjet {
namespace {

struct ExportOptions {
  std::string job;
  std::string out;
  std::string what = "mask";
  std::string cuberille;
  bool full_bed = false;
};

// A job opened for reading, with its header understood.
struct OpenJob {
  std::string path;
  JobReader reader;
  JobHeader header;
  std::vector<int> layers;  // those that have a mask
};

OpenJob open_job(const std::string& path, const Console& console) {
  JobReader reader = value_or_throw(JobReader::open(path));
  JobHeader header = parse_job_header(reader.header(), path);
  std::vector<int> layers = reader.layers(RecordKind::kMask);
  if (!reader.whole()) console.warning(path + ": " + reader.damage());
  if (layers.empty()) throw Error(ErrorKind::kBadInput, path, "holds no whole layer");
  if (static_cast<int>(layers.size()) != layers.back() - layers.front() + 1) {
    throw Error(ErrorKind::kBadInput, path, "lacks layers in its middle; join its shares first");
  }
  return {path, std::move(reader), std::move(header), std::move(layers)};
}

std::vector<std::byte> mask_bits(const OpenJob& job, int layer) {
  std::vector<std::byte> bits = value_or_throw(job.reader.read(RecordKind::kMask, layer));
  const std::size_t size = packed_row_bytes(job.header.box.size_px[0]) *
                           static_cast<std::size_t>(job.header.box.size_px[1]);
  if (bits.size() != size) {
    throw Error(ErrorKind::kBadInput, fmt::format("{}: layer {}", job.path, layer),
                "is not of the size that the job declares");
  }
  return bits;
}

RunLayer mask_layer(const OpenJob& job, int layer) {
  return unpack(mask_bits(job, layer), job.header.box.size_px[0], job.header.box.size_px[1]);
}

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

StackInfo stack_info(const OpenJob& job, StackKind kind) {
  const JobHeader& header = job.header;
  StackInfo info;
  info.kind = kind;
  info.size = {header.box.size_px[0], header.box.size_px[1], static_cast<int>(job.layers.size())};
  info.pitch_mm = header.grid.pitch_mm;
  info.origin_mm = header.origin_mm();
  info.files = word(kind) + "_%06d.png";
  info.first = job.layers.front();
  info.origin_mm[2] = info.first * info.pitch_mm[2];
  return info;
}

void export_masks(const OpenJob& job, const ExportOptions& options, const Console& console) {
  const JobHeader& header = job.header;
  StackInfo info = stack_info(job, StackKind::kMask);
  if (options.full_bed) {
    for (std::size_t axis = 0; axis < 2; ++axis) {
      info.size[axis] =
          static_cast<int>(header.profile.bed_mm[axis] / header.grid.pitch_mm[axis] + 1e-6);
      info.origin_mm[axis] = 0;
    }
  }
  StackWriter stack(options.out, info);
  Progress progress(console, "writing", info.size[2]);
  for_each_layer(info.size[2], progress, [&](int index) {
    const int layer = job.layers[static_cast<std::size_t>(index)];
    if (options.full_bed) {
      stack.write(index, window(mask_layer(job, layer), -header.box.bed_px[0],
                                -header.box.bed_px[1], info.size[0], info.size[1]));
    } else {
      stack.write_packed(index, mask_bits(job, layer));
    }
  });
  stack.finish();
}

void export_target(const OpenJob& job, const ExportOptions& options, const Console& console) {
  const JobHeader& header = job.header;
  const int rz = header.grid.detail_vx[2];
  StackInfo info = stack_info(job, StackKind::kTarget);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    info.size[axis] *= header.grid.detail_vx[axis];
    info.pitch_mm[axis] = header.grid.voxel_mm(static_cast<int>(axis));
  }
  info.first *= rz;
  const auto mesh =
      reload_parts(header, std::filesystem::path(job.path).parent_path().string());
  const LayerRange range{job.layers.front(), job.layers.back() + 1};
  const auto target = voxelize(mesh, header.grid, header.box, range);

  StackWriter stack(options.out, info);
  Progress progress(console, "writing", range.size());
  int done = 0;
  while (target->rest().size() > 0) {
    const auto block = target->next(kBlockLayers);
    const int slices = static_cast<int>(block.size()) * rz;
    oneapi::tbb::parallel_for(0, slices, [&](int s) {
      stack.write(done * rz + s, block[static_cast<std::size_t>(s / rz)]
                                     ->slices[static_cast<std::size_t>(s % rz)]);
    });
    done += static_cast<int>(block.size());
    progress.advance(done);
  }
  stack.finish();
}

void export_cuberille(const OpenJob& job, const std::string& path, const Console& console) {
  CuberilleWriter writer(path, job.header.grid);
  Progress progress(console, "writing", static_cast<int>(job.layers.size()));
  int done = 0;
  for (const int layer : job.layers) {
    writer.add(mask_layer(job, layer));
    progress.advance(++done);
  }
  writer.finish();
}

void run(const ExportOptions& options, const Console& console) {
  const OpenJob job = open_job(options.job, console);
  if (options.out.empty() == options.cuberille.empty()) {
    throw Error(ErrorKind::kUsage, "export", "name one of -o DIR and --cuberille FILE.ply");
  }
  if (options.full_bed && (options.what != "mask" || options.out.empty())) {
    throw Error(ErrorKind::kUsage, "--full-bed", "is for masks only");
  }
  if (!options.cuberille.empty()) {
    export_cuberille(job, options.cuberille, console);
  } else if (options.what == "mask") {
    export_masks(job, options, console);
  } else {
    export_target(job, options, console);
  }
  const std::string& out = options.out.empty() ? options.cuberille : options.out;
  console.result({{"out", out}, {"what", options.what}, {"layers", job.layers.size()}},
                 fmt::format("{}: {} layers", out, job.layers.size()));
}

}  // namespace

void add_export_verb(CLI::App& program) {
  CLI::App* verb = program.add_subcommand("export", "write a job's layers as pictures or a mesh");
  auto options = std::make_shared<ExportOptions>();
  verb->add_option("JOB", options->job, "a job (.bjob)")->required();
  verb->add_option("-o,--output", options->out, "the folder to write: stack.json and PNGs");
  verb->add_option("--what", options->what, "mask: what is sent; target: the voxels we want")
      ->check(CLI::IsMember({"mask", "target"}))
      ->capture_default_str();
  verb->add_flag("--full-bed", options->full_bed, "masks of the whole bed, the part in its place");
  verb->add_option("--cuberille", options->cuberille,
                   "write the masks' voxels as a PLY mesh (the paper's own output)");
  verb->callback([options, console = add_console_options(*verb)] { run(*options, *console); });
}

}  // namespace binderjet
