// SPDX-License-Identifier: GPL-3.0-or-later
// What is wrong with a print beyond single voxels: five kinds of faults, found while the layers of
// target and print pass by (slicer/MODEL.md, Faults). Whoever scores, checks or repairs a print
// asks here. One row of voxels, '#' the target's or printed, '.' powder:
//
//   target    .####...##########.   two parts
//   lost      .####.............   the second part is not printed
//   fused     .#################.   the gap is closed ...
//   joined    .#################.   ... and through it the two parts are one piece
//   spurious  .####...##########.#  printed, and no voxel of it is the target's
//   loose     .####...#####..###.   the second part's lesser piece comes off
//
// Lost and fused are more than wear takes (slicer/score/lost_and_fused.h): a wall that came out
// thinner is none. All regions are of voxels that touch by faces, in three dimensions.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <set>
#include <string_view>
#include <vector>

#include "slicer/layers/regions.h"
#include "slicer/score/lost_and_fused.h"
#include "slicer/score/pieces.h"

namespace binderjet {

enum class FaultKind { kLost, kFused, kSpurious, kLoose, kJoined };
inline constexpr std::array kFaultKinds{FaultKind::kLost, FaultKind::kFused, FaultKind::kSpurious,
                                        FaultKind::kLoose, FaultKind::kJoined};
std::string_view word(FaultKind kind);

// The region is what is lost, fused, spurious or loose, or the bridge that joins two parts; in
// voxels and slices from those of layer 0, where FaultScope::first_layer counts from.
struct Fault {
  FaultKind kind = FaultKind::kLost;
  Region region;
};

// How many there are of each kind.
class FaultCounts {
 public:
  std::int64_t& operator[](FaultKind kind) { return counts_[static_cast<std::size_t>(kind)]; }
  std::int64_t operator[](FaultKind kind) const { return counts_[static_cast<std::size_t>(kind)]; }

 private:
  std::array<std::int64_t, kFaultKinds.size()> counts_{};
};

// What is looked at, and for what. Loose and joined cost the most, for what a part and a piece hold
// is kept until the end: a search asks for the kinds that it can mend.
struct FaultScope {
  int first_layer = 0;  // the layer that is added first, in the job
  std::set<FaultKind> kinds{kFaultKinds.begin(), kFaultKinds.end()};
  // Says of a printed region whether it may go on beyond the layers that are added, where only a
  // part of a job is: then it is neither spurious nor loose, and its part's other pieces are loose
  // whatever their size. Null: nothing goes on.
  std::function<bool(const Region&)> goes_on = {};
};

class FaultFinder {
 public:
  explicit FaultFinder(int slices_per_layer, FaultScope scope = {});

  // The next layer up. Returns the faults that no later layer can go on with: they end below this
  // layer's uppermost slice. In the order lost, fused, spurious.
  std::vector<Fault> add(const VoxelLayer& target, const RunLayer& printed,
                         const LostAndFused& missing);
  // Those that reach to the end, then the loose and the joined, of which only the end tells.
  std::vector<Fault> finish();

 private:
  bool wants(FaultKind kind) const { return scope_.kinds.contains(kind); }
  // In slices, without those that touch the target or go on.
  std::vector<Region> spurious_among(const std::vector<Region>& printed) const;

  int slices_;  // of a layer
  FaultScope scope_;
  RegionFinder lost_;
  RegionFinder fused_;
  RegionFinder printed_;  // by layers: the slices of one are equal
  PieceFinder pieces_;
};

}  // namespace binderjet
