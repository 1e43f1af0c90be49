// SPDX-License-Identifier: GPL-3.0-or-later
// What a person should know of a print before any powder is spent: its faults, powder that cannot
// get out, what is too thin for the powder to carry, and where the print is wrong the deepest; each
// with its place, its words, and a verdict on all.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "driver/report/located_faults.h"
#include "slicer/layers/grid.h"
#include "slicer/score/score.h"
#include "slicer/score/thin_places.h"
#include "slicer/score/trapped_powder.h"

namespace binderjet {

// All of a kind: how many, and where the gravest are.
template <class T>
struct Found {
  std::int64_t count = 0;
  LargestOf<T> places;

  void add(const T& place) {
    ++count;
    places.add(place);
  }
};
using ThinPlaces = Found<ThinPlace>;

class Findings {
 public:
  // `origin_mm` is voxel 0, 0 of slice 0 of the job on the bed; `first_layer` is added first.
  Findings(const Grid& grid, const std::array<double, 3>& origin_mm, int first_layer);

  // The next layer up.
  void add(const LayerScore& layer);
  // What of the part, and of the powder in it, is below the rules of the profile's [strength];
  // nothing where there is no rule, or none that the grid can tell.
  void set_thin(std::optional<ThinPlaces> thin) { thin_ = std::move(thin); }
  void set_narrow(std::optional<ThinPlaces> narrow) { narrow_ = std::move(narrow); }
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
  void take(const std::vector<Fault>& faults);
  std::int64_t count(FaultKind kind) const { return score_.faults[kind]; }
  nlohmann::ordered_json worst_places() const;
  // Calls tell(how to say it, what is found of it) for each kind of which there is any.
  template <class Tell>
  void for_each_kind(const Tell& tell) const;

  Grid grid_;
  std::array<double, 3> origin_mm_;
  int first_layer_;
  Scorer scorer_;
  TrappedPowder powder_;
  std::map<FaultKind, Found<Region>> faults_;
  Found<Region> trapped_;
  std::optional<ThinPlaces> thin_;
  std::optional<ThinPlaces> narrow_;
  JobScore score_;
};

}  // namespace binderjet
