// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/enhance/inverse/repair/spurious.h"

#include <vector>

#include "slicer/enhance/inverse/search/layer_sets.h"
#include "slicer/layers/regions.h"
#include "slicer/voxels/any_slice.h"

namespace binderjet {
RunLayer spurious_print(const VoxelLayer& target, const RunLayer& printed) {
  const RunLayer wanted = any_slice(target);
  RegionFinder finder;
  finder.add(printed, &wanted);
  std::vector<Region> regions = finder.finish();
  std::erase_if(regions, [](const Region& region) { return region.touches; });
  if (regions.empty()) return RunLayer::powder(printed.width(), printed.height());

  std::vector<Rect> boxes;
  boxes.reserve(regions.size());
  for (const Region& region : regions) {
    boxes.push_back({region.low[0], region.low[1], region.high[0], region.high[1]});
  }
  return without(within(printed, boxes), wanted);
}

}  // namespace binderjet
