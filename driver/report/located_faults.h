// SPDX-License-Identifier: GPL-3.0-or-later
// The faults of a print, its thin places and its deepest wrong ones, and where on the bed they are;
// of faults and thin places a list that stays bounded, the gravest first.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "slicer/layers/grid.h"
#include "slicer/layers/regions.h"
#include "slicer/score/depth.h"
#include "slicer/score/faults.h"
#include "slicer/score/thin_places.h"

namespace binderjet {

// By voxels, then by place, then by the kind's word: an order that does not depend on the order in
// which they were found.
bool larger(const Region& a, const Region& b);
bool larger(const Fault& a, const Fault& b);
// A thin place is the graver the thinner it is.
bool larger(const ThinPlace& a, const ThinPlace& b);

// Faults, or what is none, such as pockets of trapped powder and thin places.
template <class T>
class LargestOf {
 public:
  void add(const T& found) {
    found_.push_back(found);
    if (found_.size() <= 2 * kMaxListed) return;
    std::nth_element(found_.begin(), found_.begin() + kMaxListed, found_.end(), is_larger);
    found_.resize(kMaxListed);
  }
  // At most `most`, the largest.
  std::vector<T> largest(std::size_t most = kMaxListed) const {
    std::vector<T> sorted = found_;
    std::sort(sorted.begin(), sorted.end(), is_larger);
    if (sorted.size() > most) sorted.resize(most);
    return sorted;
  }

 private:
  static constexpr std::size_t kMaxListed = 10000;
  static bool is_larger(const T& a, const T& b) { return larger(a, b); }

  std::vector<T> found_;
};

// What it is called, where on the bed (its middle), how large, in which layers; `origin_mm` is
// voxel 0, 0 of slice 0.
nlohmann::ordered_json located(std::string_view kind, const Region& region,
                               const std::array<double, 3>& origin_mm, const Grid& grid);

// The same, and how thick it is.
nlohmann::ordered_json located(std::string_view kind, const ThinPlace& place,
                               const std::array<double, 3>& origin_mm, const Grid& grid);

// A wrong voxel: what it is, where on the bed, in which layer, how deep.
nlohmann::ordered_json located(const WrongPlace& place, const std::array<double, 3>& origin_mm,
                               const Grid& grid);
// For a person, of what located() gives: "0.640 mm too thin", and with the place: "0.640 mm too
// thin at 101.5, 127.0, 3.2 mm, layer 31".
std::string wrong_text(const nlohmann::ordered_json& located);
std::string place_text(const nlohmann::ordered_json& located);

}  // namespace binderjet
