// SPDX-License-Identifier: GPL-3.0-or-later
// The smallest island and hole of a mask, found by flooding the whole of it.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "slicer/enhance/rules/mask_regions.h"

namespace binderjet::whole {

inline MaskRegions mask_regions(const RunLayer& mask) {
  const int nx = mask.width() + 2;
  const int ny = mask.height() + 2;
  std::vector<bool> seen(static_cast<std::size_t>(nx * ny), false);
  MaskRegions out;
  for (int start = 0; start < nx * ny; ++start) {
    if (seen[static_cast<std::size_t>(start)]) continue;
    const bool solid = mask.at(start % nx - 1, start / nx - 1);
    std::vector<int> found{start};
    seen[static_cast<std::size_t>(start)] = true;
    for (std::size_t next = 0; next < found.size(); ++next) {
      const int x = found[next] % nx;
      const int y = found[next] / nx;
      const auto add = [&](int a, int b) {
        if (a < 0 || b < 0 || a >= nx || b >= ny) return;
        const auto at = static_cast<std::size_t>(b * nx + a);
        if (seen[at] || mask.at(a - 1, b - 1) != solid) return;
        seen[at] = true;
        found.push_back(b * nx + a);
      };
      add(x - 1, y);
      add(x + 1, y);
      add(x, y - 1);
      add(x, y + 1);
    }
    std::int64_t& least = solid ? out.smallest_island_px : out.smallest_hole_px;
    if (start > 0) least = std::min(least, static_cast<std::int64_t>(found.size()));
  }
  return out;
}

}  // namespace binderjet::whole
