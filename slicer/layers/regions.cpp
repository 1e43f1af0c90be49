// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/layers/regions.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "slicer/layers/rows.h"

namespace binderjet {

void Region::include(const Region& other) {
  if (other.voxels == 0) return;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    low[axis] = voxels == 0 ? other.low[axis] : std::min(low[axis], other.low[axis]);
    high[axis] = voxels == 0 ? other.high[axis] : std::max(high[axis], other.high[axis]);
  }
  voxels += other.voxels;
  touches = touches || other.touches;
  widest = std::max(widest, other.widest);
}

Region in_slices(Region region, int slices_per_layer) {
  region.low[2] *= slices_per_layer;
  region.high[2] *= slices_per_layer;
  region.voxels *= slices_per_layer;
  return region;
}

std::size_t RegionFinder::root(std::size_t node) {
  while (parent_[node] != node) {
    parent_[node] = parent_[parent_[node]];
    node = parent_[node];
  }
  return node;
}

void RegionFinder::join(std::size_t a, std::size_t b) {
  a = root(a);
  b = root(b);
  if (a == b) return;
  if (b < a) std::swap(a, b);  // the older one stays, so the order of regions is their order in z
  parent_[b] = a;
  regions_[a].include(regions_[b]);
}

std::vector<Region> RegionFinder::add(const RunLayer& slice, const RunLayer* marks,
                                      std::span<const double> widths) {
  const std::size_t old = regions_.size();
  std::vector<std::size_t> of_run;
  std::size_t row_begin = 0;     // the number of the row's first run
  std::size_t below_begin = 0;   // the same in the slice below
  std::size_t before_begin = 0;  // the same in the row before
  for (int y = 0; y < slice.height(); ++y) {
    const auto row = slice.row(y);
    before_begin = std::exchange(row_begin, of_run.size());
    for (std::size_t i = 0; i < row.size(); i += 2) {
      const double width = widths.empty() ? 0 : widths[of_run.size()];
      of_run.push_back(regions_.size());
      parent_.push_back(regions_.size());
      regions_.push_back({{row[i], y, slice_},
                          {row[i + 1], y + 1, slice_ + 1},
                          row[i + 1] - row[i],
                          false,
                          width});
    }
    if (!row.empty()) {
      rows::for_each_overlap(row, slice.row(y - 1), [&](std::size_t i, std::size_t j) {
        join(of_run[row_begin + i], of_run[before_begin + j]);
      });
      rows::for_each_overlap(row, last_.row(y), [&](std::size_t i, std::size_t j) {
        join(of_run[row_begin + i], of_run_[below_begin + j]);
      });
      if (marks != nullptr) {
        rows::for_each_overlap(row, marks->row(y), [&](std::size_t i, std::size_t) {
          regions_[root(of_run[row_begin + i])].touches = true;
        });
      }
    }
    below_begin += last_.row(y).size() / 2;
  }

  // Keep the regions that this slice holds, close up their ranks, and let the others go.
  constexpr auto kNone = static_cast<std::size_t>(-1);
  std::vector<std::size_t> rank(regions_.size(), kNone);
  std::vector<Region> kept;
  for (std::size_t& region : of_run) {
    const std::size_t top = root(region);
    if (rank[top] == kNone) {
      rank[top] = kept.size();
      kept.push_back(regions_[top]);
    }
    region = rank[top];
  }
  std::vector<Region> finished;
  for (std::size_t i = 0; i < old; ++i) {
    if (parent_[i] == i && rank[i] == kNone) finished.push_back(regions_[i]);
  }
  regions_ = std::move(kept);
  parent_.resize(regions_.size());
  std::iota(parent_.begin(), parent_.end(), std::size_t{0});
  of_run_ = std::move(of_run);
  last_ = slice;
  ++slice_;
  return finished;
}

std::vector<Region> RegionFinder::finish() {
  parent_.clear();
  of_run_.clear();
  last_ = RunLayer();
  return std::exchange(regions_, {});
}

}  // namespace binderjet
