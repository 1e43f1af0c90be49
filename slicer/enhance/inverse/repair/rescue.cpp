// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/enhance/inverse/repair/rescue.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <set>
#include <utility>
#include <vector>

#include "slicer/enhance/inverse/repair/fault_weights.h"
#include "slicer/enhance/inverse/repair/spurious.h"
#include "slicer/enhance/inverse/search/loose_in_window.h"
#include "slicer/score/faults.h"
#include "slicer/voxels/any_slice.h"

namespace binderjet {
namespace {

using FaultsByOffset = std::map<int, Shared<LayerFaults>>;

class Rescue {
 public:
  Rescue(const SearchModel& by, std::span<const PrinterModel> window, LayerWindow layers,
         RescueAim aim)
      : by_(by), window_(window), layers_(layers), aim_(aim), out_(*layer_at(layers, 0)) {}

  InverseLayer run() {
    const FaultsByOffset before = faults(*out_.mask);
    least_ = weight(before);
    if (least_ > 0) search(before);
    return out_;
  }

 private:
  std::int64_t weight(const FaultsByOffset& all) const;
  LayerFaults faults_of(int offset, const RunLayer& mask,
                        std::map<int, ComparedLayer>& compared) const;
  FaultsByOffset faults(const RunLayer& mask) const;
  bool take(RunLayer mask);
  void search(const FaultsByOffset& before);

  const SearchModel& by_;
  std::span<const PrinterModel> window_;
  LayerWindow layers_;
  RescueAim aim_;
  InverseLayer out_;
  std::int64_t least_ = 0;  // the weight of what is wrong with its mask so far
};

std::int64_t Rescue::weight(const FaultsByOffset& all) const {
  std::int64_t sum = 0;
  for (const auto& [offset, of] : all) {
    for (const Fault& fault : of->faults) sum += kFeatureWeight + fault.region.voxels;
    sum += of->spurious.count();
    if (aim_ != RescueAim::features) sum += kPieceWeight * of->pieces.count;
  }
  return sum;
}

// Lost and fused as `score` finds them, but within one layer; loose as three layers show it.
LayerFaults Rescue::faults_of(int offset, const RunLayer& mask,
                              std::map<int, ComparedLayer>& compared) const {
  std::array<const ComparedLayer*, 3> seen{};
  for (int near = offset - 1; near <= offset + 1; ++near) {
    const InverseLayer* layer = layer_at(layers_, near);
    if (layer == nullptr) continue;
    if (!compared.contains(near)) {
      compared[near] = {layer->target, std::make_shared<const RunLayer>(
                                           print_with(layers_, near, by_.printer, mask))};
    }
    seen[static_cast<std::size_t>(near - offset + 1)] = &compared[near];
  }
  const VoxelLayer& target = *seen[1]->target;
  LayerFaults out{find_lost_and_fused(seen[0], *seen[1], seen[2], by_.grid),
                  {},
                  spurious_print(target, *seen[1]->printed),
                  find_loose_in_window(seen)};
  FaultFinder finder(by_.grid.detail_vx[2], {.kinds = {FaultKind::kLost, FaultKind::kFused}});
  out.faults = finder.add(target, *seen[1]->printed, out.missing);
  const std::vector<Fault> last = finder.finish();
  out.faults.insert(out.faults.end(), last.begin(), last.end());
  for (const PrinterModel& model : window_.subspan(1)) {
    const RunLayer more = spurious_print(target, print_with(layers_, offset, model, mask));
    if (more.count() > 0) out.spurious = any_slice({{out.spurious, more}});
  }
  return out;
}

// Of the layers whose print the mask changes.
FaultsByOffset Rescue::faults(const RunLayer& mask) const {
  FaultsByOffset out;
  std::map<int, ComparedLayer> compared;
  const std::set<int>& printed = by_.offsets.printed;
  for (int offset = *printed.begin(); offset <= *printed.rbegin(); ++offset) {
    if (layer_at(layers_, offset) == nullptr) continue;
    out.emplace(offset, std::make_shared<const LayerFaults>(faults_of(offset, mask, compared)));
  }
  return out;
}

// Takes the mask if less is wrong with it; true if nothing is.
bool Rescue::take(RunLayer mask) {
  const std::int64_t now = weight(faults(mask));
  if (now < least_ && no_worse_than_plain(layers_, by_.printer, by_.offsets, mask)) {
    out_.mask = std::make_shared<const RunLayer>(std::move(mask));
    least_ = now;
  }
  return least_ == 0;
}

void Rescue::search(const FaultsByOffset& before) {
  const int reach = layers_.reach().below;
  std::vector<Shared<InverseLayer>> with_stress;
  for (int offset = -reach; offset <= reach; ++offset) {
    with_stress.push_back(layers_.shared(offset));
  }
  std::vector<const RunLayer*> places;
  for (const auto& [offset, faults] : before) {
    InverseLayer layer = *layer_at(layers_, offset);
    layer.stressed.push_back(faults);
    if (offset == 0) out_.stressed.push_back(faults);
    with_stress[static_cast<std::size_t>(reach + offset)] =
        std::make_shared<const InverseLayer>(std::move(layer));
    for (const RunLayer& slice : faults->missing.lost) places.push_back(&slice);
    for (const RunLayer& slice : faults->missing.fused) places.push_back(&slice);
    places.insert(places.end(), {&faults->spurious, &faults->pieces.gap, &faults->pieces.loose});
  }
  std::vector<SearchStart> starts{{}, {.share = 0.5}, {.share = 0.01}};
  for (const int beside : {-1, 1}) {
    const InverseLayer* layer = layer_at(layers_, beside);
    if (layer != nullptr) starts.push_back({.mask = layer->mask.get()});
  }
  starts.push_back({.mask = out_.plain.get()});
  for (const SearchStart& start : starts) {
    LayerSearch search(by_, with_stress);
    search.run_near(places, start);
    if (take(search.mask())) return;
  }
}

}  // namespace

InverseLayer rescued(const SearchModel& by, std::span<const PrinterModel> window,
                     LayerWindow layers, RescueAim aim) {
  return Rescue(by, window, layers, aim).run();
}

}  // namespace binderjet
