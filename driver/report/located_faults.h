// SPDX-License-Identifier: GPL-3.0-or-later
// What was found wrong with a print, where: a list that stays bounded, the largest first.
#pragma once

#include <array>
#include <cstddef>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "slicer/layers/grid.h"
#include "slicer/layers/regions.h"

namespace binderjet {

struct Found {
  std::string kind;  // lost, fused, spurious, separated, touching, trapped
  Region region;     // in voxels and slices
};

class FoundRegions {
 public:
  void add(Found found);
  // At most `most`, the largest.
  std::vector<Found> largest(std::size_t most = kMostListed) const;

 private:
  static constexpr std::size_t kMostListed = 10000;
  std::vector<Found> found_;
};

// Where on the bed (its middle), how large, in which layers; `origin_mm` is voxel 0, 0 of slice 0.
nlohmann::ordered_json to_json(const Found& found, const std::array<double, 3>& origin_mm,
                               const Grid& grid);

}  // namespace binderjet
