// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/enhance/inverse/repair/stretch.h"

#include <algorithm>
#include <array>
#include <memory>
#include <optional>
#include <utility>

#include "slicer/enhance/inverse/repair/fault_weights.h"
#include "slicer/enhance/inverse/repair/mask_patch.h"
#include "slicer/enhance/inverse/search/layer_sets.h"

namespace binderjet {
namespace {

std::size_t at(int layer) { return static_cast<std::size_t>(layer); }

}  // namespace

PrintedLayer with_print(const SearchModel& by, LayerWindow layers) {
  const Shared<InverseLayer>& layer = layers.shared(0);
  return {layer, std::make_shared<const RunLayer>(print_with(layers, 0, by.printer, *layer->mask)),
          nullptr};
}

PrintedLayer with_missing(const SearchModel& by, const Window<PrintedLayer>& three) {
  const auto compared = [&](int offset) -> std::optional<ComparedLayer> {
    const PrintedLayer* layer = three.at(offset);
    if (layer == nullptr) return std::nullopt;
    return ComparedLayer{layer->layer->target, layer->printed};
  };
  const auto below = compared(-1);
  const auto above = compared(1);
  PrintedLayer out = three.middle();
  out.missing = std::make_shared<const LostAndFused>(
      find_lost_and_fused(below ? &*below : nullptr, {out.layer->target, out.printed},
                          above ? &*above : nullptr, by.grid));
  return out;
}

Stretch::Stretch(const SearchModel& by, Layers layers, int job_layers)
    : by_(&by),
      layers_(std::move(layers)),
      box_{0, 0, printed(0).width(), printed(0).height()},
      whole_(box_),
      open_below_(layer(0).number > 0),
      open_above_(layer(count() - 1).number + 1 < job_layers),
      faults_(faults_of(layers_)) {}

// What reaches an end may go on beyond it, where nobody looks.
bool Stretch::goes_on(const Region& region) const {
  const int slices = count() * by_->grid.detail_vx[2];
  return (open_below_ && region.low[2] == 0) || (open_above_ && region.high[2] == slices) ||
         (box_.x0 > whole_.x0 && region.low[0] <= box_.x0) ||
         (box_.y0 > whole_.y0 && region.low[1] <= box_.y0) ||
         (box_.x1 < whole_.x1 && region.high[0] >= box_.x1) ||
         (box_.y1 < whole_.y1 && region.high[1] >= box_.y1);
}

// As `score` finds them, but for joined: no mask of one part tears it from another.
Stretch::Faults Stretch::faults_of(const Layers& layers) const {
  FaultFinder finder(
      by_->grid.detail_vx[2],
      {.kinds = {FaultKind::kLost, FaultKind::kFused, FaultKind::kSpurious, FaultKind::kLoose},
       .goes_on = [this](const Region& region) { return goes_on(region); }});
  Faults faults;
  const auto take = [&faults](const std::vector<Fault>& more) {
    for (const Fault& fault : more) {
      faults.found.push_back(fault);
      faults.weight +=
          (fault.kind == FaultKind::kLoose ? kPieceWeight : kFeatureWeight) + fault.region.voxels;
    }
  };
  for (const Shared<PrintedLayer>& layer : layers) {
    take(finder.add(*layer->layer->target, *layer->printed, *layer->missing));
  }
  take(finder.finish());
  return faults;
}

RunLayer Stretch::print(const Layers& layers, int k, Shared<RunLayer> InverseLayer::*mask) const {
  const auto mask_of = [&](const Shared<PrintedLayer>& one) { return ((*one->layer).*mask).get(); };
  return by_->printer.print(runs_around(layers, k, by_->printer.window_reach(), mask_of),
                            layers[at(k)]->layer->number);
}

void Stretch::look_at(Layers& layers, int k) const {
  const auto beside = [&](int near) {
    return near < 0 || near >= static_cast<int>(layers.size()) ? nullptr : layers[at(near)];
  };
  const std::vector<Shared<PrintedLayer>> three{beside(k - 1), layers[at(k)], beside(k + 1)};
  layers[at(k)] = std::make_shared<const PrintedLayer>(with_missing(*by_, three));
}

std::int64_t Stretch::max_wrong(int k) {
  const auto known = max_wrong_.find(k);
  if (known != max_wrong_.end()) return known->second;
  const RunLayer plain = print(layers_, k, &InverseLayer::plain);
  return max_wrong_[k] =
             std::max(wrong_voxels(layer(k), printed(k)), wrong_voxels(layer(k), plain));
}

Stretch Stretch::cut(const Rect& pixels, LayerRange range) {
  const auto [rx, ry, rz] = by_->grid.detail_vx;
  const std::array in_pixels{pixels};
  const std::array in_voxels{Rect{pixels.x0 * rx, pixels.y0 * ry, pixels.x1 * rx, pixels.y1 * ry}};
  const auto part_of = [](const RunLayer& of, std::span<const Rect> places) {
    return std::make_shared<const RunLayer>(within(of, places));
  };
  Stretch out = *this;
  out.layers_.clear();
  out.max_wrong_.clear();
  out.box_ = in_voxels[0];
  out.open_below_ = open_below_ || range.first > 0;
  out.open_above_ = open_above_ || range.last < count();
  for (int k = range.first; k < range.last; ++k) {
    InverseLayer part = layer(k);
    VoxelLayer target;
    for (const RunLayer& slice : part.target->slices) {
      target.slices.push_back(within(slice, in_voxels));
    }
    part.target = std::make_shared<const VoxelLayer>(std::move(target));
    part.plain = part_of(*part.plain, in_pixels);
    part.mask = part_of(*part.mask, in_pixels);
    out.layers_.push_back(std::make_shared<const PrintedLayer>(
        std::make_shared<const InverseLayer>(std::move(part)), nullptr, nullptr));
  }
  for (int k = 0; k < out.count(); ++k) {
    PrintedLayer part = *out.layers_[at(k)];
    part.printed = std::make_shared<const RunLayer>(out.print(out.layers_, k, &InverseLayer::mask));
    // The whole layer may still get as much worse.
    const int here = k + range.first;
    out.max_wrong_[k] = max_wrong(here) - wrong_voxels(layer(here), printed(here)) +
                        wrong_voxels(*part.layer, *part.printed);
    out.layers_[at(k)] = std::make_shared<const PrintedLayer>(std::move(part));
  }
  for (int k = 0; k < out.count(); ++k) out.look_at(out.layers_, k);
  out.faults_ = out.faults_of(out.layers_);
  return out;
}

RunLayer Stretch::filling(const Patch& patch, const InverseLayer& of) const {
  switch (patch.filling) {
    case Patch::Filling::plain:
      return *of.plain;
    case Patch::Filling::with_plain:
      return either(*of.mask, *of.plain);
    case Patch::Filling::common_with_plain:
      return common(*of.mask, *of.plain);
    case Patch::Filling::copy:
      break;
  }
  return *layer(patch.copied).mask;
}

bool Stretch::take(const Patch& patch) {
  Layers next = layers_;
  const std::array places{patch.pixels};
  for (int k = patch.layers.first; k < patch.layers.last; ++k) {
    InverseLayer changed = layer(k);
    changed.mask = std::make_shared<const RunLayer>(
        patched(*changed.mask, filling(patch, changed), places, by_->rules));
    next[at(k)] = std::make_shared<const PrintedLayer>(
        std::make_shared<const InverseLayer>(std::move(changed)), nullptr, nullptr);
  }
  const LayerRange prints =
      grown(patch.layers, LayerReach::both_sides(by_->printer.window_reach()), {0, count()});
  for (int k = prints.first; k < prints.last; ++k) {
    auto print_of = std::make_shared<const RunLayer>(print(next, k, &InverseLayer::mask));
    if (wrong_voxels(layer(k), *print_of) > max_wrong(k)) return false;
    next[at(k)] = std::make_shared<const PrintedLayer>(next[at(k)]->layer, std::move(print_of),
                                                       layers_[at(k)]->missing);
  }
  const LayerRange seen = grown(prints, LayerReach::both_sides(1), {0, count()});
  for (int k = seen.first; k < seen.last; ++k) {
    // The ends lack a neighbor, but keep what was seen with it.
    const bool at_end = (k == 0 && open_below_) || (k == count() - 1 && open_above_);
    if (!at_end) look_at(next, k);
  }
  Faults now = faults_of(next);
  if (now.weight >= faults_.weight) return false;
  layers_ = std::move(next);
  faults_ = std::move(now);
  return true;
}

}  // namespace binderjet
