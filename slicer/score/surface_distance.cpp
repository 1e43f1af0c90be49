// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/score/surface_distance.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <numeric>
#include <tuple>

namespace binderjet {
namespace {

double gap_mm(int voxels, double voxel_mm) {
  return std::max(0.0, std::abs(voxels) - 0.5) * voxel_mm;
}

// The most voxels along an axis that are nearer than `radius_mm`.
int reach(double radius_mm, double voxel_mm) {
  int voxels = 0;
  while (gap_mm(voxels + 1, voxel_mm) < radius_mm) ++voxels;
  return voxels;
}

// Calls take(first, last) for the runs of the row's voxels in [first, last) that are `solid`.
template <class Take>
void for_each_run(std::span<const int> flips, int first, int last, bool solid, const Take& take) {
  auto flip = std::upper_bound(flips.begin(), flips.end(), first);
  bool is_solid = (flip - flips.begin()) % 2 == 1;
  for (int x = first; x < last; ++flip) {
    const int end = flip == flips.end() ? last : std::min(*flip, last);
    if (is_solid == solid) take(x, end);
    is_solid = !is_solid;
    if (end == last) return;
    x = end;
  }
}

// Places from 0 on, each of which is taken once: next(i) is the first at or after i that is left.
class PlacesLeft {
 public:
  explicit PlacesLeft(int count) : next_(static_cast<std::size_t>(count) + 1) {
    std::iota(next_.begin(), next_.end(), 0);
  }
  int next(int place) {
    int left = place;
    while (at(left) != left) left = at(left);
    while (at(place) != left) place = std::exchange(at(place), left);
    return left;
  }
  void take(int place) { at(place) = place + 1; }

 private:
  int& at(int place) { return next_[static_cast<std::size_t>(place)]; }
  std::vector<int> next_;
};

}  // namespace

SurfaceDistance::SurfaceDistance(const Grid& grid, double max_mm)
    : max_mm_(max_mm),
      voxel_x_mm_(grid.voxel_mm(0)),
      reach_slices_(reach(max_mm, grid.voxel_mm(2))) {
  const int reach_y = reach(max_mm, grid.voxel_mm(1));
  for (int z = -reach_slices_; z <= reach_slices_; ++z) {
    for (int y = -reach_y; y <= reach_y; ++y) {
      const double gap2 =
          std::pow(gap_mm(y, grid.voxel_mm(1)), 2) + std::pow(gap_mm(z, grid.voxel_mm(2)), 2);
      if (gap2 < max_mm * max_mm) offsets_.push_back({y, z, gap2});
    }
  }
  std::sort(offsets_.begin(), offsets_.end(), [](const Offset& a, const Offset& b) {
    return std::tie(a.gap2_mm2, a.z, a.y) < std::tie(b.gap2_mm2, b.z, b.y);
  });
}

void SurfaceDistance::search(std::span<const RunLayer* const> slices, int y, int first, int last,
                             bool solid, double radius_mm, double* squares) const {
  const int reach_x = reach(radius_mm, voxel_x_mm_);
  const int begin = first - reach_x;
  const int count = last - first + 2 * reach_x;
  // By x: the least gap(dy)^2 + gap(dz)^2 to a voxel of the other state.
  std::vector<double> beside(static_cast<std::size_t>(count),
                             std::numeric_limits<double>::infinity());
  PlacesLeft left(count);
  for (const Offset& offset : offsets_) {
    // What comes later is farther than all that the run has straight beside it.
    if (offset.gap2_mm2 >= radius_mm * radius_mm || left.next(reach_x) >= last - begin) break;
    const RunLayer* slice = slices[static_cast<std::size_t>(reach_slices_ + offset.z)];
    const std::span<const int> row =
        slice == nullptr ? std::span<const int>() : slice->row(y + offset.y);
    for_each_run(row, begin, begin + count, !solid, [&](int from, int to) {
      for (int i = left.next(from - begin); i < to - begin; i = left.next(i)) {
        beside[static_cast<std::size_t>(i)] = offset.gap2_mm2;
        left.take(i);
      }
    });
  }
  for (int x = first; x < last; ++x) {
    const double* here = beside.data() + (x - begin);
    double best = std::min(*here, radius_mm * radius_mm);
    for (int dx = 1; dx <= reach_x; ++dx) {
      const double gap2 = std::pow(gap_mm(dx, voxel_x_mm_), 2);
      if (gap2 >= best) break;
      best = std::min(best, gap2 + std::min(here[-dx], here[dx]));
    }
    *squares++ = best < radius_mm * radius_mm ? best : max_mm_ * max_mm_;
  }
}

void SurfaceDistance::of_run(std::span<const RunLayer* const> slices, int y, int first, int last,
                             bool solid, std::vector<double>& distances_mm) const {
  assert(static_cast<int>(slices.size()) == 2 * reach_slices_ + 1);
  const double none = max_mm_ * max_mm_;
  distances_mm.assign(static_cast<std::size_t>(last - first), none);
  double* squares = distances_mm.data();
  const int count = last - first;
  for (double radius_mm = max_mm_ / 32;; radius_mm = std::min(max_mm_, 4 * radius_mm)) {
    bool all = true;
    for (int i = 0; i < count;) {
      int end = i;
      while (end < count && squares[end] >= none) ++end;
      if (end > i) {
        search(slices, y, first + i, first + end, solid, radius_mm, squares + i);
        all = all && std::all_of(squares + i, squares + end, [&](double d) { return d < none; });
      }
      i = end + 1;
    }
    if (all || radius_mm >= max_mm_) break;
  }
  for (double& distance : distances_mm) distance = std::sqrt(distance);
}

}  // namespace binderjet
