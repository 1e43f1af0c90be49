// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/score/voxel_counts.h"

#include <algorithm>
#include <utility>
#include <vector>

namespace binderjet {
namespace {

double ratio(std::int64_t part, std::int64_t whole) {
  return whole == 0 ? 0 : static_cast<double>(part) / static_cast<double>(whole);
}

}  // namespace

VoxelCounts& VoxelCounts::operator+=(const VoxelCounts& other) {
  solid += other.solid;
  missing += other.missing;
  extra += other.extra;
  unavoidable += other.unavoidable;
  return *this;
}

double VoxelCounts::wrong() const { return ratio(missing + extra, solid); }
double VoxelCounts::floor() const { return ratio(unavoidable, solid); }
double VoxelCounts::excess() const { return wrong() - floor(); }

VoxelCounts count_voxels(const VoxelLayer& target, const RunLayer& printed) {
  const auto rz = static_cast<std::int64_t>(target.slices.size());
  VoxelCounts counts;
  std::vector<std::pair<int, int>> flips;  // x, slice; slice -1 is the printed row
  for (int y = 0; y < printed.height(); ++y) {
    flips.clear();
    for (const int x : printed.row(y)) flips.emplace_back(x, -1);
    for (int s = 0; s < rz; ++s) {
      for (const int x : target.slices[static_cast<std::size_t>(s)].row(y))
        flips.emplace_back(x, s);
    }
    std::sort(flips.begin(), flips.end());

    // Between two flips every column is the same: `ones` of its rz target voxels are 1.
    std::vector<bool> inside(static_cast<std::size_t>(rz), false);
    bool is_printed = false;
    std::int64_t ones = 0;
    for (std::size_t i = 0; i < flips.size(); ++i) {
      if (i > 0) {
        const std::int64_t length = flips[i].first - flips[i - 1].first;
        counts.solid += length * ones;
        counts.unavoidable += length * std::min(ones, rz - ones);
        if (is_printed) {
          counts.extra += length * (rz - ones);
        } else {
          counts.missing += length * ones;
        }
      }
      if (flips[i].second < 0) {
        is_printed = !is_printed;
      } else {
        std::vector<bool>::reference state = inside[static_cast<std::size_t>(flips[i].second)];
        state = !state;
        ones += state ? 1 : -1;
      }
    }
  }
  return counts;
}

}  // namespace binderjet
