// SPDX-License-Identifier: GPL-3.0-or-later
#include "driver/job/print_stream.h"

#include <oneapi/tbb/parallel_for.h>

#include <utility>

#include "slicer/model/print_masks.h"

namespace binderjet {

Pipeline<RunLayer> printed_layers(const MaskSource& masks, const PrinterModel& model,
                                  const Work& work) {
  const Pipeline<RunLayer> read(
      "read masks", masks.layers(), [&masks](LayerRange) { return masks.stream(); }, work);
  // Not owned: the model outlives this.
  return print_masks(read, {std::shared_ptr<const void>(), &model});
}

std::unique_ptr<Stream<RunLayer>> printed_stream(const MaskSource& masks, const PrinterModel& model,
                                                 const Work& work) {
  return printed_layers(masks, model, work).all_layers();
}

Pipeline<RunLayer> printed_job(const JobHeader& header, std::shared_ptr<const Mesh> mesh,
                               std::shared_ptr<const PrinterModel> model,
                               std::shared_ptr<MaskTally> tally, const Work& work) {
  const auto count = [tally = std::move(tally)](int, const Window<MaskLayer>& window) {
    tally->pixels += window.middle().mask.count();
    const std::lock_guard lock(tally->mutex);
    tally->rules.add(window.middle().changes);
    return window.middle().mask;
  };
  return print_masks(job_masks(header, std::move(mesh), work).then("count pixels", {}, count),
                     std::move(model));
}

GiveName write_printed(const MaskSource& masks, const PrinterModel& model, const Grid& grid,
                       const std::string& folder, const Work& work) {
  StackInfo info = masks.stack_info(StackKind::kPrinted);
  for (std::size_t axis = 0; axis < 2; ++axis) {
    info.size[axis] *= grid.detail_vx[axis];
    info.pitch_mm[axis] = masks.pitch_mm[axis] / grid.detail_vx[axis];
  }
  const auto stack = std::make_shared<StackWriter>(folder, info);
  Stage stage(work, "simulating", info.size[2], "layers");
  const auto printed = printed_stream(masks, model, work);
  int done = 0;
  while (printed->rest().size() > 0) {
    const auto block = printed->next(kBlockLayers);
    const int count = static_cast<int>(block.size());
    oneapi::tbb::parallel_for(
        0, count, [&](int i) { stack->write(done + i, *block[static_cast<std::size_t>(i)]); });
    done += count;
    stage.reach(done);
  }
  stack->complete();
  return [stack] { stack->finish(); };
}

}  // namespace binderjet
