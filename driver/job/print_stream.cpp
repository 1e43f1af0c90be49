// SPDX-License-Identifier: GPL-3.0-or-later
#include "driver/job/print_stream.h"

#include <oneapi/tbb/parallel_for.h>

namespace binderjet {

std::unique_ptr<Stream<RunLayer>> printed_stream(const MaskSource& masks,
                                                 const PrinterModel& model) {
  using Print = Step<RunLayer, RunLayer>;
  const LayerRange layers = masks.layers();
  return std::make_unique<Print>(
      masks.stream(), layers, model.window_reach(), layers,
      [&model](int layer, Print::Window window) { return model.print(window, layer); });
}

void write_printed(const MaskSource& masks, const PrinterModel& model, const Grid& grid,
                   const std::string& folder, const Console& console) {
  StackInfo info = masks.stack_info(StackKind::kPrinted);
  for (std::size_t axis = 0; axis < 2; ++axis) {
    info.size[axis] *= grid.detail_vx[axis];
    info.pitch_mm[axis] = masks.pitch_mm[axis] / grid.detail_vx[axis];
  }
  StackWriter stack(folder, info);
  Progress progress(console, "simulating", info.size[2]);
  const auto printed = printed_stream(masks, model);
  int done = 0;
  while (printed->rest().size() > 0) {
    const auto block = printed->next(kBlockLayers);
    const int count = static_cast<int>(block.size());
    oneapi::tbb::parallel_for(
        0, count, [&](int i) { stack.write(done + i, *block[static_cast<std::size_t>(i)]); });
    done += count;
    progress.advance(done);
  }
  stack.finish();
}

}  // namespace binderjet
