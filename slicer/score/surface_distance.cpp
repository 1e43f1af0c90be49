// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/score/surface_distance.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <utility>

#include "slicer/layers/rows.h"

namespace binderjet {
namespace {

constexpr double kFar = std::numeric_limits<double>::infinity();
// Within this part of what is searched, rows are looked at for the run alone, else kept.
constexpr double kNearPart = 1.0 / 16;

double gap2_mm2(int voxels, double voxel_mm) {
  const double gap_mm = std::max(0.0, std::abs(voxels) - 0.5) * voxel_mm;
  return gap_mm * gap_mm;
}

// The most voxels along an axis that are nearer than `radius_mm`.
int reach(double radius_mm, double voxel_mm) {
  return static_cast<int>(std::ceil(radius_mm / voxel_mm + 0.5)) - 1;
}

// Whether the voxels of `open` are all `solid`, or all powder, in `row`.
bool is_all(rows::Row open, rows::Row row, bool solid) {
  std::size_t j = 0;
  for (std::size_t i = 0; i < open.size(); i += 2) {
    while (j < row.size() && row[j + 1] <= open[i]) j += 2;
    const bool meets = j < row.size() && row[j] < open[i + 1];
    if (!solid && meets) return false;
    if (solid && !(meets && row[j] <= open[i] && open[i + 1] <= row[j + 1])) return false;
  }
  return true;
}

}  // namespace

int SurfaceDistance::reach_slices(const Grid& grid, double max_mm) {
  return reach(max_mm, grid.voxel_mm(2));
}

SurfaceDistance::SurfaceDistance(const Grid& grid, double max_mm,
                                 std::span<const RunLayer* const> slices)
    : max_mm_(max_mm),
      voxel_mm_{grid.voxel_mm(0), grid.voxel_mm(1), grid.voxel_mm(2)},
      slices_(slices) {
  assert(static_cast<int>(slices.size()) == 2 * reach_slices(grid, max_mm) + 1);
}

SurfaceDistance::Stretches SurfaceDistance::along_z(int y, int first, int last, bool solid,
                                                    double radius_mm) const {
  Stretches found;
  std::vector<int> open{first, last};  // has met no other state so far
  std::vector<int> next;
  std::vector<int> met;
  const int middle = static_cast<int>(slices_.size() / 2);
  const int reach_z = reach(radius_mm, voxel_mm_[2]);
  const auto meet = [&](int dz) {
    const RunLayer* slice = slices_[static_cast<std::size_t>(middle + dz)];
    const rows::Row row = slice == nullptr ? rows::Row() : slice->row(y);
    if (is_all(open, row, solid)) return;
    if (solid) {
      rows::intersect(open, row, next);
    } else {
      rows::subtract(open, row, next);
    }
    rows::subtract(open, next, met);
    for (std::size_t i = 0; i < met.size(); i += 2) {
      found.push_back({met[i], met[i + 1], gap2_mm2(dz, voxel_mm_[2])});
    }
    std::swap(open, next);
  };
  meet(0);
  for (int dz = 1; dz <= reach_z && !open.empty(); ++dz) {
    meet(-dz);
    meet(dz);
  }
  std::sort(found.begin(), found.end(),
            [](const Stretch& a, const Stretch& b) { return a.first < b.first; });
  return found;
}

const SurfaceDistance::Stretches& SurfaceDistance::whole_row(int y, bool solid) {
  const RunLayer& slice = *slices_[slices_.size() / 2];
  const int reach_x = reach(max_mm_, voxel_mm_[0]);
  const int reach_y = reach(max_mm_, voxel_mm_[1]);
  std::vector<std::optional<Stretches>>& rows = rows_[solid ? 1 : 0];
  rows.resize(static_cast<std::size_t>(slice.height() + 2 * reach_y));
  std::optional<Stretches>& row = rows[static_cast<std::size_t>(y + reach_y)];
  if (!row) row = along_z(y, -reach_x, slice.width() + reach_x, solid, max_mm_);
  return *row;
}

void SurfaceDistance::search(int y, int first, int last, bool solid, double radius_mm,
                             double* squares) {
  const double radius2 = radius_mm * radius_mm;
  const bool near = radius_mm <= max_mm_ * kNearPart;
  const int reach_x = reach(radius_mm, voxel_mm_[0]);
  const int reach_y = reach(radius_mm, voxel_mm_[1]);
  const int begin = first - reach_x;
  const int end = last + reach_x;
  // By x: the least gap(dy)^2 + gap(dz)^2 to a voxel of the other state.
  std::vector<double> beside(static_cast<std::size_t>(end - begin), kFar);
  for (int n = 0; n <= reach_y; ++n) {
    const double gap2 = gap2_mm2(n, voxel_mm_[1]);
    const auto take = [&](const Stretches& row) {
      auto stretch = std::partition_point(row.begin(), row.end(),
                                          [&](const Stretch& one) { return one.last <= begin; });
      for (; stretch != row.end() && stretch->first < end; ++stretch) {
        const double here2 = gap2 + stretch->gap2_mm2;
        if (here2 >= radius2) continue;
        double* const from = beside.data() + (std::max(stretch->first, begin) - begin);
        double* const to = beside.data() + (std::min(stretch->last, end) - begin);
        for (double* at = from; at < to; ++at) *at = std::min(*at, here2);
      }
    };
    // Rows that are farther than all that the run has straight beside it change nothing.
    if (std::all_of(beside.begin() + reach_x, beside.end() - reach_x,
                    [&](double square) { return square <= gap2; })) {
      break;
    }
    for (const int dy : {-n, n}) {
      if (near) {
        take(along_z(y + dy, begin, end, solid, radius_mm));
      } else {
        take(whole_row(y + dy, solid));
      }
      if (n == 0) break;
    }
  }

  std::vector<double> gaps2(static_cast<std::size_t>(reach_x) + 1);  // by dx
  for (int dx = 0; dx <= reach_x; ++dx) {
    gaps2[static_cast<std::size_t>(dx)] = gap2_mm2(dx, voxel_mm_[0]);
  }
  std::fill(squares, squares + (last - first), max_mm_ * max_mm_);
  const auto is_found = [](double square) { return square < kFar; };
  // The first from x - reach_x on with anything beside it.
  auto ahead = std::find_if(beside.begin(), beside.end(), is_found);
  for (int x = first; x < last; ++x) {
    const auto middle = beside.begin() + (x - begin);
    if (ahead < middle - reach_x) ahead = std::find_if(middle - reach_x, beside.end(), is_found);
    if (ahead > middle + reach_x) {
      // Nothing is near: on to where `ahead` is.
      x = std::min(last, begin + static_cast<int>(ahead - beside.begin()) - reach_x) - 1;
      continue;
    }
    double best = std::min(*middle, radius2);
    for (int dx = 1; dx <= reach_x && gaps2[static_cast<std::size_t>(dx)] < best; ++dx) {
      best = std::min(
          best, gaps2[static_cast<std::size_t>(dx)] + std::min(*(middle - dx), *(middle + dx)));
    }
    if (best < radius2) squares[x - first] = best;
  }
}

void SurfaceDistance::of_run(int y, int first, int last, bool solid,
                             std::vector<double>& distances_mm) {
  const double none = max_mm_ * max_mm_;
  distances_mm.assign(static_cast<std::size_t>(last - first), none);
  double* const squares = distances_mm.data();
  double* const end = squares + distances_mm.size();
  for (double radius_mm = max_mm_ * kNearPart;; radius_mm *= 4) {
    bool found_all = true;
    for (double* from = squares; (from = std::find(from, end, none)) != end;) {
      double* const to = std::find_if(from, end, [&](double square) { return square < none; });
      search(y, first + static_cast<int>(from - squares), first + static_cast<int>(to - squares),
             solid, radius_mm, from);
      found_all = found_all && std::find(from, to, none) == to;
      from = to;
    }
    if (found_all || radius_mm >= max_mm_) break;
  }
  for (double& distance : distances_mm) distance = std::sqrt(distance);
}

}  // namespace binderjet
