// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/enhance/inverse/judge.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <span>

#include "slicer/enhance/inverse/mask_patch.h"
#include "slicer/enhance/inverse/search/layer_sets.h"
#include "slicer/enhance/inverse/spurious.h"
#include "slicer/layers/rows.h"
#include "slicer/score/faults.h"
#include "slicer/score/lost_and_fused.h"
#include "slicer/score/pieces.h"
#include "slicer/voxels/any_slice.h"

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

// What a piece that comes off and what a feature that is lost, fused or spurious weigh, in voxels.
constexpr std::int64_t kPieceWeight = 200;
constexpr std::int64_t kFeatureWeight = 100;

// A bridge to a loose piece may begin this far from the piece along x and y, in voxels.
constexpr int kBridgeVx = 4;

// Prints by their offset from the middle layer.
using Prints = std::map<int, Shared<RunLayer>>;

// A layer with the one below and the one above; null beyond the job's ends.
class Neighbors {
 public:
  Neighbors(const LayerWindow& layers, const Prints& prints, int offset) {
    for (std::size_t i = 0; i < layers_.size(); ++i) {
      const int at = offset + static_cast<int>(i) - 1;
      if (layers.at(at) != nullptr) layers_[i] = {layers.at(at)->target, prints.at(at)};
    }
  }
  const ComparedLayer& middle() const { return layers_[1]; }
  const ComparedLayer* below() const { return there(0); }
  const ComparedLayer* above() const { return there(2); }

 private:
  const ComparedLayer* there(std::size_t i) const {
    return layers_[i].target == nullptr ? nullptr : &layers_[i];
  }

  std::array<ComparedLayer, 3> layers_;
};

// The pieces that come off as three layers show them (what holds together only beyond these looks
// loose here), and what a bridge in the middle layer could be made of: target voxels around the
// pieces that are not printed.
struct Loose {
  std::int64_t count = 0;
  RunLayer gap;
};
Loose find_loose(const Neighbors& of) {
  const auto& [target, printed] = of.middle();
  PieceFinder pieces(static_cast<int>(target->slices.size()), 0, Contacts::kIgnore);
  for (const ComparedLayer* layer : {of.below(), &of.middle(), of.above()}) {
    if (layer != nullptr) pieces.add(*layer->target, *layer->printed);
  }
  std::vector<Rect> around;
  for (const Region& piece : pieces.loose()) {
    around.push_back(
        Rect{piece.low[0], piece.low[1], piece.high[0], piece.high[1]}.grown(kBridgeVx, kBridgeVx));
  }
  return {std::ssize(around), around.empty()
                                  ? RunLayer::powder(printed->width(), printed->height())
                                  : within(without(any_slice(*target), *printed), around)};
}

// What is lost, fused, spurious or comes off in a layer.
FoundFaults find_broken(const Neighbors& of, const Grid& grid) {
  const auto& [target, printed] = of.middle();
  const LostAndFused found = find_lost_and_fused(of.below(), of.middle(), of.above(), grid);
  Loose loose = find_loose(of);
  FaultFinder finder(grid.detail_vx[2],
                     {.kinds = {FaultKind::kLost, FaultKind::kFused, FaultKind::kSpurious}});
  const std::size_t ended = finder.add(*target, *printed, found).size();
  const std::size_t features = ended + finder.finish().size();

  SearchFaults faults{0, std::move(loose.gap), spurious_print(*target, *printed)};
  for (const RunLayer& slice : found.lost) faults.missing = either(faults.missing, slice);
  for (const RunLayer& slice : found.fused) faults.surplus = either(faults.surplus, slice);
  const std::int64_t weight = kPieceWeight * loose.count +
                              kFeatureWeight * static_cast<std::int64_t>(features) +
                              faults.missing.count() + faults.surplus.count();
  return {{std::move(faults)}, weight};
}

Prints prints_so_far(const LayerWindow& layers, int first, int last) {
  Prints prints;
  for (int at = first; at <= last; ++at) {
    if (layers.at(at) != nullptr) prints[at] = layers.at(at)->printed;
  }
  return prints;
}

}  // namespace

FoundFaults find_broken(const LayerWindow& layers, const Grid& grid) {
  return find_broken(Neighbors(layers, prints_so_far(layers, -1, 1), 0), grid);
}

bool is_known(const LayerWindow& layers, int offset) {
  return layers.at(offset)->judged == prints_around(layers, offset, 1);
}

std::vector<Shared<RunLayer>> prints_around(const LayerWindow& layers, int offset, int around) {
  std::vector<Shared<RunLayer>> out;
  for (int at = offset - around; at <= offset + around; ++at) {
    out.push_back(layers.at(at) == nullptr ? nullptr : layers.at(at)->printed);
  }
  return out;
}

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

FoundFaults Judge::too_deep(const RunLayer& own) const {
  FoundFaults out;
  for (const auto& [offset, layer] : printed_) {
    const RunLayer printed = print_with(layers_, offset, by_.printer, own);
    const VoxelLayer& target = *layers_.at(offset)->target;
    SearchFaults of{
        offset,
        deeper(without(common(layer.solid, layer.plain), printed), target, by_.grid, layer.deep_mm),
        deeper(without(without(printed, layer.plain), layer.any), target, by_.grid, layer.deep_mm)};
    out.weight += of.missing.count() + of.surplus.count();
    out.faults.push_back(std::move(of));
  }
  return out;
}

FoundFaults Judge::broken(const RunLayer& own) const {
  const int first = *by_.offsets.printed.begin() - 1;
  const int last = *by_.offsets.printed.rbegin() + 1;
  Prints prints = prints_so_far(layers_, first - 1, last + 1);
  for (const auto& [offset, layer] : printed_) {
    prints[offset] =
        std::make_shared<const RunLayer>(print_with(layers_, offset, by_.printer, own));
  }
  std::map<int, FoundFaults> found;
  for (int at = first; at <= last; ++at) {
    if (layers_.at(at) == nullptr) continue;
    found.emplace(at, find_broken(Neighbors(layers_, prints, at), by_.grid));
  }
  return with_faults_beside(prints, found, too_deep(own));
}

FoundFaults Judge::broken() const {
  const int first = *by_.offsets.printed.begin() - 1;
  const int last = *by_.offsets.printed.rbegin() + 1;
  const Prints prints = prints_so_far(layers_, first - 1, last + 1);
  std::map<int, FoundFaults> found;
  for (int at = first; at <= last; ++at) {
    if (layers_.at(at) == nullptr) continue;
    found.emplace(at, is_known(layers_, at)
                          ? *layers_.at(at)->broken
                          : find_broken(Neighbors(layers_, prints, at), by_.grid));
  }
  return with_faults_beside(prints, found, too_deep(*layers_.middle().mask));
}

// A spike's tip that is lost needs what is below it, so what is missing beside is missing here,
// where it is target and not printed.
FoundFaults Judge::with_faults_beside(const Prints& prints, const std::map<int, FoundFaults>& found,
                                      FoundFaults deep) const {
  FoundFaults out = std::move(deep);
  for (const auto& [at, of] : found) {
    out.weight += of.weight;
    if (!printed_.contains(at)) continue;
    SearchFaults faults = of.faults.front();
    faults.offset = at;
    for (const int beside : {at - 1, at + 1}) {
      if (!found.contains(beside) || found.at(beside).weight == 0) continue;
      const RunLayer& missing = found.at(beside).faults.front().missing;
      const RunLayer unprinted = without(any_slice(*layers_.at(at)->target), *prints.at(at));
      faults.missing = either(faults.missing, common(missing, unprinted));
    }
    out.faults.push_back(std::move(faults));
  }
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
