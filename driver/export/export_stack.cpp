// SPDX-License-Identifier: GPL-3.0-or-later
#include "driver/export/export_stack.h"

#include <oneapi/tbb/parallel_for.h>

#include <utility>

#include "driver/base/layer_blocks.h"
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
  const StackInfo box = job.stack_info(StackKind::kMask);
  if (frame.size == box.size && frame.origin_mm == box.origin_mm) return job.packed(index);
  const auto& corner = job.header->box.bed_px;
  return pack(window(job.read(index), -corner[0], -corner[1], frame.size[0], frame.size[1]));
}

void demand_color(const MaskSource& job) {
  if (job.color) return;
  throw Error(ErrorKind::kUsage, job.path, "has no color; its models had none when it was sliced");
}

GiveName export_masks(const MaskSource& job, const std::string& folder, bool full_bed,
                      const Work& work) {
  const StackInfo info = mask_info(job, full_bed);
  const auto stack = std::make_shared<StackWriter>(folder, info);
  Stage stage(work, "writing masks", info.size[2], "layers");
  for_each_layer(info.size[2], stage,
                 [&](int index) { stack->write_packed(index, mask_bits(job, info, index)); });
  stack->complete();
  return [stack] { stack->finish(); };
}

GiveName export_target(const MaskSource& job, std::shared_ptr<const Mesh> mesh,
                       const std::string& folder, const Work& work) {
  const JobHeader& header = *job.header;
  const int rz = header.grid.detail_vx[2];
  StackInfo info = job.stack_info(StackKind::kTarget);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    info.size[axis] *= header.grid.detail_vx[axis];
    info.pitch_mm[axis] = header.grid.voxel_mm(static_cast<int>(axis));
  }
  info.first *= rz;
  const auto target = voxelize(std::move(mesh), header.grid, header.box, job.layers());

  const auto stack = std::make_shared<StackWriter>(folder, info);
  Stage stage(work, "writing target", job.size_px[2], "layers");
  int done = 0;
  while (target->rest().size() > 0) {
    const auto block = target->next(kBlockLayers);
    oneapi::tbb::parallel_for(0, static_cast<int>(block.size()) * rz, [&](int s) {
      stack->write(
          done * rz + s,
          block[static_cast<std::size_t>(s / rz)]->slices[static_cast<std::size_t>(s % rz)]);
    });
    done += static_cast<int>(block.size());
    stage.reach(done);
  }
  stack->complete();
  return [stack] { stack->finish(); };
}

GiveName export_color(const MaskSource& job, const std::string& folder, const Work& work) {
  demand_color(job);
  const auto stack = std::make_shared<StackWriter>(folder, job.stack_info(StackKind::kColor));
  Stage stage(work, "writing color", job.size_px[2], "layers");
  for_each_layer(job.size_px[2], stage,
                 [&](int index) { stack->write_rgb(index, job.color(index)); });
  stack->complete();
  return [stack] { stack->finish(); };
}

GiveName export_planes(const MaskSource& job, const std::string& folder, const Work& work) {
  demand_color(job);
  std::vector<std::shared_ptr<StackWriter>> stacks;
  for (const char* ink : kInks) {
    StackInfo info = job.stack_info(StackKind::kColor);
    info.files = std::string(ink) + "_%06d.png";
    stacks.push_back(std::make_shared<StackWriter>(folder + "/" + ink, info));
  }
  Stage stage(work, "writing drops", job.size_px[2], "layers");
  for_each_layer(job.size_px[2], stage, [&](int index) {
    std::vector<std::byte> rgb = job.color(index);
    whiten_outside(job.read(index), rgb);
    const std::array<RunLayer, 3> planes =
        separate_cmy(rgb, job.size_px[0], job.size_px[1], job.first + index);
    for (std::size_t c = 0; c < 3; ++c) stacks[c]->write(index, planes[c]);
  });
  for (const auto& stack : stacks) stack->complete();
  return [stacks] {
    for (const auto& stack : stacks) stack->finish();
  };
}

}  // namespace binderjet
