// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/enhance/inverse/spurious.h"

#include <vector>

#include "slicer/enhance/inverse/search/layer_sets.h"
#include "slicer/score/faults.h"
#include "slicer/voxels/any_slice.h"

namespace binderjet {

RunLayer spurious_print(const VoxelLayer& target, const RunLayer& printed) {
  const auto slices = static_cast<int>(target.slices.size());
  FaultFinder finder(slices, {.kinds = {FaultKind::kSpurious}});
  finder.add(target, printed, {});  // nothing can end below the first layer
  const std::vector<Fault> faults = finder.finish();
  if (faults.empty()) return RunLayer::powder(printed.width(), printed.height());

  std::vector<Rect> boxes;
  boxes.reserve(faults.size());
  for (const auto& [kind, region] : faults) {
    boxes.push_back({region.low[0], region.low[1], region.high[0], region.high[1]});
  }
  return without(within(printed, boxes), any_slice(target));
}

}  // namespace binderjet
