// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/enhance/inverse/judge.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <span>

#include "slicer/enhance/inverse/loose_in_window.h"
#include "slicer/enhance/inverse/mask_patch.h"
#include "slicer/enhance/inverse/search/layer_sets.h"
#include "slicer/enhance/inverse/spurious.h"
#include "slicer/layers/rows.h"
#include "slicer/score/faults.h"
#include "slicer/score/lost_and_fused.h"

namespace binderjet {
namespace {

constexpr int kFar = 1 << 20;  // voxels

// How many voxels along a row to one of the other state; 1 if x itself is one's neighbor.
int steps_along(std::span<const int> row, int x, bool solid) {
  const auto after = std::upper_bound(row.begin(), row.end(), x);
  const auto at = after - row.begin();
  if ((at % 2 == 1) != solid) return 0;
  const int left = at == 0 ? x + kFar : x - row[static_cast<std::size_t>(at - 1)] + 1;
  const int right = after == row.end() ? kFar : *after - x;
  return std::min(left, right);
}

// The depth of a voxel in a slice, as far as `most_mm`.
double depth_mm(const RunLayer& slice, int x, int y, const Grid& grid, double most_mm) {
  const bool solid = steps_along(slice.row(y), x, true) > 0;
  double least = most_mm;
  for (int dy = 0; dy * grid.voxel_mm(1) < least; ++dy) {
    for (const int beside : {y - dy, y + dy}) {
      const bool inside = beside >= 0 && beside < slice.height();
      const int steps = steps_along(inside ? slice.row(beside) : rows::Row(), x, solid);
      least = std::min(least, std::hypot(steps * grid.voxel_mm(0), dy * grid.voxel_mm(1)));
    }
  }
  return least;
}

// Of the voxels those that are deeper than this in all slices.
RunLayer deeper(const RunLayer& voxels, const VoxelLayer& target, const Grid& grid,
                double least_mm) {
  RunLayer out(voxels.width());
  std::vector<int> row;
  for (int y = 0; y < voxels.height(); ++y) {
    const rows::Row of = voxels.row(y);
    row.clear();
    for (std::size_t i = 0; i < of.size(); i += 2) {
      for (int x = of[i]; x < of[i + 1]; ++x) {
        const bool deep =
            std::all_of(target.slices.begin(), target.slices.end(), [&](const RunLayer& slice) {
              return depth_mm(slice, x, y, grid, 2 * least_mm) > least_mm + 1e-9;
            });
        if (!deep) continue;
        if (!row.empty() && row.back() == x) {
          ++row.back();
        } else {
          row.insert(row.end(), {x, x + 1});
        }
      }
    }
    out.append_row(row);
  }
  return out;
}

// The depth of the deepest of the voxels, between two bounds.
double deepest_mm(const RunLayer& voxels, const VoxelLayer& target, const Grid& grid,
                  double least_mm, double most_mm) {
  double deepest = least_mm;
  for (int y = 0; y < voxels.height() && deepest < most_mm; ++y) {
    const rows::Row row = voxels.row(y);
    for (std::size_t i = 0; i < row.size() && deepest < most_mm; i += 2) {
      for (int x = row[i]; x < row[i + 1] && deepest < most_mm; ++x) {
        double depth = most_mm;
        for (const RunLayer& slice : target.slices) {
          depth = std::min(depth, depth_mm(slice, x, y, grid, most_mm));
        }
        deepest = std::max(deepest, depth);
      }
    }
  }
  return deepest;
}

// What a piece that comes off and what a feature that is lost or fused weigh, in voxels.
constexpr std::int64_t kPieceWeight = 200;
constexpr std::int64_t kFeatureWeight = 100;

}  // namespace

Judge::Judge(const SearchModel& by, const LayerWindow& layers) : by_(by), layers_(layers) {
  for (const int offset : by.offsets.printed) {
    if (layers.at(offset) == nullptr) continue;
    const VoxelLayer& target = *layers.at(offset)->target;
    RunLayer solid = target.slices.front();
    RunLayer any = target.slices.front();
    for (const RunLayer& slice : target.slices) {
      solid = common(solid, slice);
      any = either(any, slice);
    }
    RunLayer plain = print_plain(layers, offset, by.printer);
    const double deep_mm = deepest_mm(either(without(solid, plain), without(plain, any)), target,
                                      by.grid, kShallowMm, kDeepMm);
    printed_.emplace(offset, Layer{std::move(solid), std::move(any), std::move(plain), deep_mm});
  }
}

template <class Find>
FoundFaults Judge::faults(Find find) const {
  FoundFaults out;
  for (const auto& [offset, layer] : printed_) {
    SearchFaults of = find(offset, layer);
    of.offset = offset;
    out.weight += of.missing.count() + of.surplus.count();
    out.faults.push_back(std::move(of));
  }
  return out;
}

FoundFaults Judge::too_deep(const RunLayer& own) const {
  return faults([&](int offset, const Layer& layer) {
    const RunLayer printed = print_with(layers_, offset, by_.printer, own);
    const VoxelLayer& target = *layers_.at(offset)->target;
    return SearchFaults{
        0,
        deeper(without(common(layer.solid, layer.plain), printed), target, by_.grid, layer.deep_mm),
        deeper(without(without(printed, layer.plain), layer.any), target, by_.grid, layer.deep_mm)};
  });
}

FoundFaults Judge::broken(const RunLayer& own) const {
  std::int64_t pieces = 0;
  std::size_t features = 0;
  FoundFaults out = faults([&](int offset, const Layer&) {
    std::array<std::optional<ComparedLayer>, 3> seen;
    for (const int beside : {-1, 0, 1}) {
      const int at = offset + beside;
      if (layers_.at(at) == nullptr) continue;
      seen[static_cast<std::size_t>(beside + 1)] = ComparedLayer{
          layers_.shared(at)->target,
          std::make_shared<const RunLayer>(print_with(layers_, at, by_.printer, own))};
    }
    std::array<const ComparedLayer*, 3> window{};
    for (std::size_t i = 0; i < 3; ++i) window[i] = seen[i] ? &*seen[i] : nullptr;
    const LostAndFused found = find_lost_and_fused(window[0], *window[1], window[2], by_.grid);
    const LooseInWindow loose = find_loose_in_window(window);
    pieces += loose.count;
    FaultFinder finder(by_.grid.detail_vx[2], {.kinds = {FaultKind::kLost, FaultKind::kFused}});
    features += finder.add(*window[1]->target, *window[1]->printed, found).size();
    features += finder.finish().size();
    SearchFaults of{0, loose.gap, spurious_print(*window[1]->target, *window[1]->printed)};
    for (const RunLayer& slice : found.lost) of.missing = either(of.missing, slice);
    for (const RunLayer& slice : found.fused) of.surplus = either(of.surplus, slice);
    return of;
  });
  out.weight += kPieceWeight * pieces + kFeatureWeight * static_cast<std::int64_t>(features);
  FoundFaults deep = too_deep(own);
  out.weight += deep.weight;
  for (SearchFaults& of : deep.faults) out.faults.push_back(std::move(of));
  return out;
}

std::int64_t Judge::wrong_voxels(const RunLayer& own) const {
  std::int64_t sum = 0;
  for (const auto& [offset, layer] : printed_) {
    sum +=
        binderjet::wrong_voxels(*layers_.at(offset), print_with(layers_, offset, by_.printer, own));
  }
  return sum;
}

bool Judge::no_worse_than_plain(const RunLayer& own) const {
  return std::all_of(printed_.begin(), printed_.end(), [&](const auto& of) {
    const auto& [offset, layer] = of;
    const InverseLayer& at = *layers_.at(offset);
    return binderjet::wrong_voxels(at, print_with(layers_, offset, by_.printer, own)) <=
           binderjet::wrong_voxels(at, layer.plain);
  });
}

RunLayer Judge::held(const RunLayer& own) const {
  const RunLayer& so_far = *layers_.middle().mask;
  const std::array<int, 2> reach = by_.printer.reach().xy_vx;
  const int around_px =
      std::max(reach[0] / by_.grid.detail_vx[0], reach[1] / by_.grid.detail_vx[1]) + 1;
  // Around each fault no more than it takes: a place that goes back to the mask so far loses what
  // the search had gained there.
  RunLayer out = own;
  std::vector<Rect> places;
  for (int px = 1; px <= 4 * around_px; ++px) {
    const FoundFaults found = too_deep(out);
    if (found.weight == 0) return no_worse_than_plain(out) ? out : so_far;
    for (const SearchFaults& of : found.faults) {
      for (const RunLayer* voxels : {&of.missing, &of.surplus}) {
        const std::vector<Rect> more = pixels_around(*voxels, by_.grid, std::min(px, around_px));
        places.insert(places.end(), more.begin(), more.end());
      }
    }
    out = patched(own, so_far, places, by_.rules);
  }
  return so_far;
}

}  // namespace binderjet
