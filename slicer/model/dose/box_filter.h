// SPDX-License-Identifier: GPL-3.0-or-later
// A box filter and a threshold on runs: the core of binder spread, at the cost of the boundary.
//
// Each flip of the input adds a ramp of fixed shape to the filtered row, so a row's second
// difference is four numbers per flip and two running sums give the row. Between the ramps the sum
// is constant and nothing is computed. All sums are integers: the result is exact for the weights.
#pragma once

#include <array>
#include <cstdint>

#include "slicer/layers/run_layer.h"

namespace binderjet {

// A centred box of exact width w voxels along one axis (DESIGN section 5): the weight of offset i
// is the overlap of [i - 1/2, i + 1/2] with [-w/2, w/2], as an integer. Offsets -reach and reach
// weigh `end`, those between weigh `full`; a box within one voxel has reach 0 and weighs `end`.
struct BoxWeights {
  int reach = 0;
  std::int64_t full = 1;
  std::int64_t end = 1;

  std::int64_t total() const { return reach == 0 ? end : 2 * end + (2 * reach - 1) * full; }
  std::int64_t at(int offset) const {
    const int distance = offset < 0 ? -offset : offset;
    return distance > reach ? 0 : distance == reach ? end : full;
  }
};

// Weights in units of 2^-16 voxels; the fraction at the ends is rounded to them.
BoxWeights box_weights(double width_vx);

// A voxel of the result is 1 iff the weighted sum over its neighbourhood, x.at(dx) * y.at(dy) for
// each voxel that is 1, is at least `least` (> 0). Every pixel of the input is repeat[0] x
// repeat[1] voxels of the result. Outside is powder.
RunLayer box_threshold(const RunLayer& in, std::array<int, 2> repeat, const BoxWeights& x,
                       const BoxWeights& y, std::int64_t least);

// The least weighted sum that is a dose of at least `level` (0 < level <= 1).
std::int64_t least_sum(const BoxWeights& x, const BoxWeights& y, double level);

}  // namespace binderjet
