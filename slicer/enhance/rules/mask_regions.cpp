// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/enhance/rules/mask_regions.h"

#include <algorithm>
#include <vector>

#include "slicer/layers/regions.h"
#include "slicer/layers/rows.h"

namespace binderjet {
namespace {

std::vector<Region> regions_of(const RunLayer& layer) {
  RegionFinder finder;
  finder.add(layer);
  return finder.finish();
}

}  // namespace

MaskRegions& MaskRegions::operator+=(const MaskRegions& other) {
  smallest_island_px = std::min(smallest_island_px, other.smallest_island_px);
  smallest_hole_px = std::min(smallest_hole_px, other.smallest_hole_px);
  return *this;
}

MaskRegions mask_regions(const RunLayer& mask) {
  MaskRegions out;
  for (const Region& island : regions_of(mask)) {
    out.smallest_island_px = std::min(out.smallest_island_px, island.voxels);
  }
  RunLayer powder(mask.width());
  std::vector<int> row;
  const int all[] = {0, mask.width()};
  for (int y = 0; y < mask.height(); ++y) {
    rows::subtract(all, mask.row(y), row);
    powder.append_row(row);
  }
  for (const Region& hole : regions_of(powder)) {
    const bool inside = hole.low[0] > 0 && hole.low[1] > 0 && hole.high[0] < mask.width() &&
                        hole.high[1] < mask.height();
    if (inside) out.smallest_hole_px = std::min(out.smallest_hole_px, hole.voxels);
  }
  return out;
}

}  // namespace binderjet
