// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/enhance/inverse/search/prices.h"

#include <algorithm>
#include <cstddef>
#include <span>

namespace binderjet {

std::vector<std::int16_t> voxel_prices(const VoxelLayer& target, const Band& band) {
  const auto all = static_cast<std::int16_t>(kPriceUnit * target.slices.size());
  std::vector<std::int16_t> out(band.size(), all);
  for (const RunLayer& slice : target.slices) {
    for (int y = band.first_row(); y < band.last_row(); ++y) {
      const std::span<const int> row = slice.row(y);
      std::size_t i = 0;
      for (const BandRun& run : band.row(y)) {
        while (i < row.size() && row[i + 1] <= run.x0) i += 2;
        for (std::size_t at = i; at < row.size() && row[at] < run.x1; at += 2) {
          const int end = std::min(run.x1, row[at + 1]);
          std::int16_t* to = out.data() + run.first - run.x0;
          for (int x = std::max(run.x0, row[at]); x < end; ++x) {
            to[x] = static_cast<std::int16_t>(to[x] - 2 * kPriceUnit);
          }
        }
      }
    }
  }
  return out;
}

}  // namespace binderjet
