// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/score/faults.h"

#include <utility>

#include "slicer/voxels/any_slice.h"

namespace binderjet {
namespace {

void take(FaultKind kind, const std::vector<Region>& regions, std::vector<Fault>& out) {
  for (const Region& region : regions) out.push_back({kind, region});
}

}  // namespace

std::string_view word(FaultKind kind) {
  switch (kind) {
    case FaultKind::kLost:
      return "lost";
    case FaultKind::kFused:
      return "fused";
    case FaultKind::kSpurious:
      return "spurious";
    case FaultKind::kLoose:
      return "loose";
    case FaultKind::kJoined:
      break;
  }
  return "joined";
}

FaultFinder::FaultFinder(int slices_per_layer, FaultScope scope)
    : slices_(slices_per_layer),
      scope_(std::move(scope)),
      lost_(scope_.first_layer * slices_),
      fused_(scope_.first_layer * slices_),
      printed_(scope_.first_layer),
      pieces_(slices_, scope_.first_layer,
              wants(FaultKind::kJoined) ? Contacts::kFind : Contacts::kIgnore) {}

std::vector<Region> FaultFinder::spurious_among(const std::vector<Region>& printed) const {
  std::vector<Region> out;
  for (const Region& region : printed) {
    if (region.touches) continue;
    const Region slices = in_slices(region, slices_);
    if (!scope_.goes_on || !scope_.goes_on(slices)) out.push_back(slices);
  }
  return out;
}

std::vector<Fault> FaultFinder::add(const VoxelLayer& target, const RunLayer& printed,
                                    const LostAndFused& missing) {
  std::vector<Fault> ended;
  if (wants(FaultKind::kLost)) {
    for (const RunLayer& slice : missing.lost) take(FaultKind::kLost, lost_.add(slice), ended);
  }
  if (wants(FaultKind::kFused)) {
    for (const RunLayer& slice : missing.fused) take(FaultKind::kFused, fused_.add(slice), ended);
  }
  if (wants(FaultKind::kSpurious)) {
    const RunLayer wanted = any_slice(target);
    take(FaultKind::kSpurious, spurious_among(printed_.add(printed, &wanted)), ended);
  }
  if (wants(FaultKind::kLoose) || wants(FaultKind::kJoined)) pieces_.add(target, printed);
  return ended;
}

std::vector<Fault> FaultFinder::finish() {
  std::vector<Fault> ended;
  take(FaultKind::kLost, lost_.finish(), ended);
  take(FaultKind::kFused, fused_.finish(), ended);
  take(FaultKind::kSpurious, spurious_among(printed_.finish()), ended);
  if (wants(FaultKind::kLoose)) take(FaultKind::kLoose, pieces_.loose(scope_.goes_on), ended);
  if (wants(FaultKind::kJoined)) take(FaultKind::kJoined, pieces_.joined(), ended);
  return ended;
}

}  // namespace binderjet
