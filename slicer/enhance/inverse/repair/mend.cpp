// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/enhance/inverse/repair/mend.h"

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include "slicer/layers/regions.h"

namespace binderjet {
namespace {

// A patch reaches so many pixels and layers beyond the fault.
constexpr std::array<int, 4> kAroundPx{0, 1, 3, 7};
constexpr int kAroundLayers = 3;
// What is seen around a patch and what it changes, in pixels and in layers: wear, and neighbors.
constexpr int kBeside = 4;
// Noise has no end of faults; only so many of a stretch, the largest, are worth the time.
constexpr std::size_t kMaxFaults = 64;

// From near to far. Only layers of `own` change, only layers of `seen` are copied.
std::vector<Patch> patches(LayerRange fault, const Rect& pixels, LayerRange own, LayerRange seen) {
  std::vector<Patch> out;
  const auto add = [&](LayerRange layers, int around_px, Patch::Filling filling, int copied) {
    layers = {std::max(layers.first, own.first), std::min(layers.last, own.last)};
    if (layers.size() <= 0 || copied < seen.first || copied >= seen.last) return;
    out.push_back({layers, pixels.grown(around_px, around_px), filling, copied});
  };
  for (const int px : kAroundPx) {
    for (int more = 0; more < kAroundLayers; ++more) {
      const LayerRange layers{fault.first - more, fault.last + more};
      for (const Patch::Filling filling :
           {Patch::Filling::plain, Patch::Filling::with_plain, Patch::Filling::common_with_plain}) {
        add(layers, px, filling, fault.first);
      }
      // What is missing lies below a piece or above it; a feature is as the layers beside it are.
      add({layers.first - 1, fault.first}, px, Patch::Filling::copy, fault.first);
      add({fault.last, layers.last + 1}, px, Patch::Filling::copy, fault.last - 1);
      add(layers, px, Patch::Filling::copy, layers.first - 1);
      add(layers, px, Patch::Filling::copy, layers.last);
    }
  }
  return out;
}

class Mending {
 public:
  Mending(const SearchModel& by, Stretch::Layers layers, LayerRange own, int job_layers)
      : by_(by), own_(own), all_(by, std::move(layers), job_layers) {}

  Stretch::Layers run() {
    std::vector<Fault> faults = all_.faults().found;
    std::stable_sort(faults.begin(), faults.end(), [](const Fault& a, const Fault& b) {
      return a.region.voxels > b.region.voxels;
    });
    if (faults.size() > kMaxFaults) faults.resize(kMaxFaults);
    for (const Fault& fault : faults) mend(fault.region);
    const Stretch::Layers& layers = all_.layers();
    return {layers.begin() + own_.first, layers.begin() + own_.last};
  }

 private:
  void mend(const Region& fault);

  const SearchModel& by_;
  LayerRange own_;
  Stretch all_;
};

// Tries on what is near the fault, for layers are large.
void Mending::mend(const Region& fault) {
  const auto [rx, ry, rz] = by_.grid.detail_vx;
  const Rect pixels{fault.low[0] / rx, fault.low[1] / ry, (fault.high[0] - 1) / rx + 1,
                    (fault.high[1] - 1) / ry + 1};
  const LayerRange layers{fault.low[2] / rz, (fault.high[2] - 1) / rz + 1};
  const auto [reach_x, reach_y] = by_.printer.reach().xy_vx;
  const int around_px = kAroundPx.back() + kBeside;
  const Rect near = pixels.grown(around_px + 2 * reach_x / rx, around_px + 2 * reach_y / ry);
  const LayerRange near_layers = grown(
      layers, LayerReach::both_sides(kAroundLayers + 2 * by_.printer.window_reach() + kBeside),
      {0, all_.count()});
  std::optional<Stretch> part;
  for (Patch patch : patches(layers, pixels, own_, near_layers)) {
    if (!part.has_value()) part = all_.cut(near, near_layers);
    const std::size_t before = part->faults().found.size();
    if (!part->take(patch.moved(-near_layers.first))) continue;
    if (!all_.take(patch)) {
      part.reset();
    } else if (part->faults().found.size() < before) {
      return;
    }
  }
}

}  // namespace

Stretch::Layers mended(const SearchModel& by, Stretch::Layers layers, LayerRange own,
                       int job_layers) {
  return Mending(by, std::move(layers), own, job_layers).run();
}

}  // namespace binderjet
