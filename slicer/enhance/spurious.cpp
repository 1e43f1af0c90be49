// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/enhance/spurious.h"

#include <algorithm>
#include <vector>

#include "slicer/any_slice.h"
#include "slicer/regions.h"
#include "slicer/rows.h"

namespace binderjet {
RunLayer spurious_print(const VoxelLayer& target, const RunLayer& printed) {
  const RunLayer wanted = any_slice(target);
  RegionFinder finder;
  finder.add(printed, &wanted);
  std::vector<Region> regions = finder.finish();
  std::erase_if(regions, [](const Region& region) { return region.touches; });
  if (regions.empty()) return RunLayer::powder(printed.width(), printed.height());

  RunLayer out(printed.width());
  std::vector<int> boxes;
  std::vector<int> sum;
  std::vector<int> inside;
  std::vector<int> row;
  for (int y = 0; y < printed.height(); ++y) {
    boxes.clear();
    for (const Region& region : regions) {
      if (y < region.low[1] || y >= region.high[1]) continue;
      const int ends[] = {region.low[0], region.high[0]};
      rows::unite(boxes, ends, sum);
      boxes.swap(sum);
    }
    rows::intersect(printed.row(y), boxes, inside);
    rows::subtract(inside, wanted.row(y), row);
    out.append_row(row);
  }
  return out;
}

}  // namespace binderjet
