// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/score/depth.h"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "slicer/layers/rows.h"

namespace binderjet {
namespace {

// The columns of row y in which at least `most` slices are solid.
void columns_with(const VoxelLayer& target, int y, int most, std::vector<int>& out) {
  std::vector<std::pair<int, int>> flips;  // x, and by how much the solid slices change
  for (const RunLayer& slice : target.slices) {
    int change = 1;
    for (const int x : slice.row(y)) flips.emplace_back(x, std::exchange(change, -change));
  }
  std::sort(flips.begin(), flips.end());
  out.clear();
  int ones = 0;
  for (std::size_t i = 0; i < flips.size();) {
    const int x = flips[i].first;
    const int before = ones;
    for (; i < flips.size() && flips[i].first == x; ++i) ones += flips[i].second;
    if ((before >= most) != (ones >= most)) out.push_back(x);
  }
}

}  // namespace

std::string_view word(WrongKind kind) {
  switch (kind) {
    case WrongKind::kLost:
      return "lost";
    case WrongKind::kFused:
      return "fused";
    case WrongKind::kMissing:
      return "missing";
    case WrongKind::kExtra:
      break;
  }
  return "extra";
}

bool deeper(const WrongPlace& a, const WrongPlace& b) {
  const auto key = [](const WrongPlace& place) {
    return std::tuple(-place.depth_mm, static_cast<int>(place.kind), place.voxel[2], place.voxel[1],
                      place.voxel[0]);
  };
  return key(a) < key(b);
}

Depths::Depths(const Grid& grid)
    : voxel_mm_{grid.voxel_mm(0), grid.voxel_mm(1), grid.voxel_mm(2)},
      named_mm_(*std::max_element(grid.pitch_mm.begin(), grid.pitch_mm.end())),
      of_um_(static_cast<std::size_t>(kMaxMm * 1000) + 1, 0) {}

void Depths::add(WrongPlace first, std::span<const double> depths_mm) {
  count_ += static_cast<std::int64_t>(depths_mm.size());
  const int begin = first.voxel[0];
  const int end = begin + static_cast<int>(depths_mm.size());
  // The deepest voxel of each cell; of equals the first.
  for (WrongPlace wrong = first; wrong.voxel[0] < end;) {
    int next = wrong.voxel[0] + 1;
    while (next < end && cell_along(0, next) == cell_along(0, wrong.voxel[0])) ++next;
    const auto in_cell = depths_mm.subspan(static_cast<std::size_t>(wrong.voxel[0] - begin),
                                           static_cast<std::size_t>(next - wrong.voxel[0]));
    for (const double depth_mm : in_cell) {
      ++of_um_[static_cast<std::size_t>(std::lround(depth_mm * 1e3))];
    }
    const auto deepest = std::max_element(in_cell.begin(), in_cell.end());
    wrong.depth_mm = *deepest;
    wrong.voxel[0] += static_cast<int>(deepest - in_cell.begin());
    if (!worst_ || deeper(wrong, *worst_)) worst_ = wrong;
    if (wrong.depth_mm > named_mm_) keep(wrong);
    wrong.voxel[0] = next;
  }
}

Depths& Depths::operator+=(const Depths& other) {
  for (std::size_t i = 0; i < of_um_.size(); ++i) of_um_[i] += other.of_um_[i];
  count_ += other.count_;
  if (other.worst_ && (!worst_ || deeper(*other.worst_, *worst_))) worst_ = other.worst_;
  for (const auto& [cell, wrong] : other.cells_) keep(wrong);
  return *this;
}

int Depths::cell_along(std::size_t axis, int voxel) const {
  return static_cast<int>(voxel * voxel_mm_[axis] / kCellMm);
}

Depths::Cell Depths::cell_of(const WrongPlace& wrong) const {
  const bool extra = wrong.kind == WrongKind::kFused || wrong.kind == WrongKind::kExtra;
  return {extra ? 1 : 0, cell_along(0, wrong.voxel[0]), cell_along(1, wrong.voxel[1]),
          cell_along(2, wrong.voxel[2])};
}

void Depths::keep(const WrongPlace& wrong) {
  const auto [cell, is_new] = cells_.try_emplace(cell_of(wrong), wrong);
  if (!is_new && deeper(wrong, cell->second)) cell->second = wrong;
  if (cells_.size() <= kMaxCells) return;
  std::vector<WrongPlace> all;
  for (const auto& [key, place] : cells_) all.push_back(place);
  const auto half = all.begin() + kMaxCells / 2;
  std::nth_element(all.begin(), half, all.end(), deeper);
  std::for_each(half, all.end(), [&](const WrongPlace& place) { cells_.erase(cell_of(place)); });
}

double Depths::p999_mm() const {
  std::int64_t within = 0;
  for (std::size_t um = 0; um < of_um_.size(); ++um) {
    within += of_um_[um];
    if (within * 1000 >= count_ * 999) return static_cast<double>(um) * 1e-3;
  }
  return kMaxMm;
}

std::vector<WrongPlace> Depths::places(std::size_t most) const {
  std::vector<WrongPlace> sorted;
  for (const auto& [cell, place] : cells_) sorted.push_back(place);
  std::sort(sorted.begin(), sorted.end(), deeper);
  std::map<Cell, WrongPlace> left = cells_;
  std::vector<WrongPlace> places;
  for (const WrongPlace& deepest : sorted) {
    if (places.size() == most) break;
    if (left.erase(cell_of(deepest)) == 0) continue;  // hangs together with a deeper one
    places.push_back(deepest);
    std::vector<Cell> open{cell_of(deepest)};
    while (!open.empty()) {
      const Cell cell = open.back();
      open.pop_back();
      for (int i = 0; i < 27; ++i) {
        const Cell near{cell[0], cell[1] + i % 3 - 1, cell[2] + i / 3 % 3 - 1, cell[3] + i / 9 - 1};
        if (left.erase(near) > 0) open.push_back(near);
      }
    }
  }
  return places;
}

LayerReach DepthFinder::reach() const {
  const int rz = grid_.detail_vx[2];
  return LayerReach::both_sides((reach_slices_ + rz - 1) / rz);
}

Depths DepthFinder::find(int layer, const Window<ComparedLayer>& window,
                         const LostAndFused& missing) const {
  Depths depths(grid_);
  const int rz = grid_.detail_vx[2];
  const int below = window.reach().below;
  std::vector<const RunLayer*> slices(static_cast<std::size_t>((2 * below + 1) * rz), nullptr);
  for (int offset = -below; offset <= below; ++offset) {
    const ComparedLayer* compared = window.at(offset);
    if (compared == nullptr) continue;
    for (int s = 0; s < rz; ++s) {
      slices[static_cast<std::size_t>((below + offset) * rz + s)] =
          &compared->target->slices[static_cast<std::size_t>(s)];
    }
  }

  const VoxelLayer& target = *window.middle().target;
  const RunLayer& printed = *window.middle().printed;
  std::vector<SurfaceDistance> distances;  // by slice of the layer
  for (int s = 0; s < rz; ++s) {
    distances.emplace_back(
        grid_, Depths::kMaxMm,
        std::span(slices).subspan(static_cast<std::size_t>(below * rz + s - reach_slices_),
                                  2 * static_cast<std::size_t>(reach_slices_) + 1));
  }
  std::vector<int> columns, too_little, too_much, wrong, runs;
  std::vector<double> depths_mm;
  for (int y = 0; y < printed.height(); ++y) {
    columns_with(target, y, rz / 2 + 1, columns);
    rows::subtract(columns, printed.row(y), too_little);
    columns_with(target, y, (rz + 1) / 2, columns);
    rows::subtract(printed.row(y), columns, too_much);
    for (int s = 0; s < rz; ++s) {
      const auto index = static_cast<std::size_t>(s);
      const auto add = [&](WrongKind kind, bool solid) {
        for (std::size_t i = 0; i < runs.size(); i += 2) {
          distances[index].of_run(y, runs[i], runs[i + 1], solid, depths_mm);
          depths.add({0, {runs[i], y, layer * rz + s}, kind}, depths_mm);
        }
      };
      rows::intersect(too_little, target.slices[index].row(y), wrong);
      rows::intersect(wrong, missing.lost[index].row(y), runs);
      add(WrongKind::kLost, true);
      rows::subtract(wrong, missing.lost[index].row(y), runs);
      add(WrongKind::kMissing, true);
      rows::subtract(too_much, target.slices[index].row(y), wrong);
      rows::intersect(wrong, missing.fused[index].row(y), runs);
      add(WrongKind::kFused, false);
      rows::subtract(wrong, missing.fused[index].row(y), runs);
      add(WrongKind::kExtra, false);
    }
  }
  return depths;
}

}  // namespace binderjet
