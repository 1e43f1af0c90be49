// SPDX-License-Identifier: GPL-3.0-or-later
// What a person should know of a print before any powder is spent: its faults, powder that cannot
// get out, and where it is wrong the deepest; each with its place, its words, and a verdict on all.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <string>

#include "driver/report/located_faults.h"
#include "slicer/layers/grid.h"
#include "slicer/score/score.h"
#include "slicer/score/trapped_powder.h"

namespace binderjet {

class Findings {
 public:
  // `origin_mm` is voxel 0, 0 of slice 0 of the job on the bed; `first_layer` is added first.
  Findings(const Grid& grid, const std::array<double, 3>& origin_mm, int first_layer);

  // The next layer up.
  void add(const LayerScore& layer);
  // Once, after the last layer; before all that follows.
  void finish();

  const JobScore& score() const { return score_; }
  // What the print does, as a person would say it: "loses detail and comes apart".
  std::string verdict() const;
  // How many there are of each kind, found[], worst_places[].
  nlohmann::ordered_json to_json() const;
  // The same for a person, in lines; of each kind the largest, of places the deepest.
  std::string text() const;
  // Where to look, the deepest places first, then the largest of each kind:
  // {"say", "at_mm", "layer", "size_mm": [x, y]}.
  nlohmann::ordered_json to_look_at() const;

 private:
  // All of a kind: how many, and where the largest are.
  struct Kind {
    std::int64_t count = 0;
    LargestOf<Region> regions;

    void add(const Region& region) {
      ++count;
      regions.add(region);
    }
  };

  void take(const std::vector<Fault>& faults);
  std::int64_t count(FaultKind kind) const { return score_.faults[kind]; }
  nlohmann::ordered_json worst_places() const;

  Grid grid_;
  std::array<double, 3> origin_mm_;
  int first_layer_;
  Scorer scorer_;
  TrappedPowder powder_;
  std::map<FaultKind, Kind> faults_;
  Kind trapped_;
  JobScore score_;
};

}  // namespace binderjet
