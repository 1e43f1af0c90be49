// SPDX-License-Identifier: GPL-3.0-or-later
#include "driver/export/export_stack.h"

#include <array>
#include <filesystem>
#include <memory>

#include "driver/base/layer_blocks.h"
#include "driver/job/parts.h"
#include "slicer/base/error.h"
#include "slicer/color/separate.h"
#include "slicer/stack/slice_stack.h"
#include "slicer/voxels/voxelize.h"

namespace binderjet {

StackInfo mask_info(const MaskSource& job, bool full_bed) {
  StackInfo info = job.stack_info(StackKind::kMask);
  if (!full_bed) return info;
  const JobHeader& header = *job.header;
  for (std::size_t axis = 0; axis < 2; ++axis) {
    info.size[axis] = header.profile.bed(header.grid).pixels(static_cast<int>(axis));
    info.origin_mm[axis] = 0;
  }
  return info;
}

std::vector<std::byte> mask_bits(const MaskSource& job, const StackInfo& frame, int index) {
  if (frame.size == job.size_px) return job.packed(index);
  const auto& corner = job.header->box.bed_px;
  return pack(window(job.read(index), -corner[0], -corner[1], frame.size[0], frame.size[1]));
}

void demand_color(const MaskSource& job) {
  if (job.color) return;
  throw Error(ErrorKind::kUsage, job.path, "has no color; its models had none when it was sliced");
}

void export_masks(const MaskSource& job, const std::string& folder, bool full_bed,
                  const Console& console) {
  const StackInfo info = mask_info(job, full_bed);
  StackWriter stack(folder, info);
  Progress progress(console, "writing", info.size[2]);
  for_each_layer(info.size[2], progress,
                 [&](int index) { stack.write_packed(index, mask_bits(job, info, index)); });
  stack.finish();
}

void export_target(const MaskSource& job, const std::string& folder, const Console& console) {
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

  StackWriter stack(folder, info);
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

void export_color(const MaskSource& job, const std::string& folder, const Console& console) {
  demand_color(job);
  StackWriter stack(folder, job.stack_info(StackKind::kColor));
  Progress progress(console, "writing", job.size_px[2]);
  for_each_layer(job.size_px[2], progress,
                 [&](int index) { stack.write_rgb(index, job.color(index)); });
  stack.finish();
}

void export_planes(const MaskSource& job, const std::string& folder, const Console& console) {
  demand_color(job);
  constexpr std::array<const char*, 3> kInks = {"cyan", "magenta", "yellow"};
  std::vector<std::unique_ptr<StackWriter>> stacks;
  for (const char* ink : kInks) {
    StackInfo info = job.stack_info(StackKind::kColor);
    info.files = std::string(ink) + "_%06d.png";
    stacks.push_back(std::make_unique<StackWriter>(folder + "/" + ink, info));
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

}  // namespace binderjet
