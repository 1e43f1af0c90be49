// SPDX-License-Identifier: GPL-3.0-or-later
// The smallest island of binder and the smallest hole in a mask, for whoever doubts that it keeps
// to the rules of its profile (slicer/enhance/rules/mask_rules.h).
#pragma once

#include <cstdint>
#include <limits>

#include "slicer/layers/run_layer.h"

namespace binderjet {

// In pixels that meet at their sides; the largest number where there are none. The powder around
// the mask is no hole.
struct MaskRegions {
  std::int64_t smallest_island_px = std::numeric_limits<std::int64_t>::max();
  std::int64_t smallest_hole_px = std::numeric_limits<std::int64_t>::max();

  MaskRegions& operator+=(const MaskRegions& other);
};

MaskRegions mask_regions(const RunLayer& mask);

}  // namespace binderjet
