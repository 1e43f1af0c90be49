// SPDX-License-Identifier: GPL-3.0-or-later
// A box filter and a threshold on runs: the core of binder spread, at the cost of the boundary.
//
// Each flip of the input adds a ramp of fixed shape to the filtered row:
//
//   input row         .  .    .    #    #    #   #  #     one flip up
//   box of 4 voxels      1/2  1    1    1    1/2          weights, in units
//   sum               0  .5   1.5  2.5  3.5  4   4  4     the ramp
//
// The ramp's second difference is four numbers, so two running sums give the row. Between ramps the
// sum is constant and nothing is computed. Where ramps do not meet, which is most rows, even the
// ramp is not followed: it passes `least` once, at a place that is found directly. All sums are
// integers: the result is exact for the weights.
#pragma once

#include <array>
#include <cstdint>

#include "slicer/layers/run_layer.h"

namespace binderjet {

// A centered box of exact width w voxels along one axis (slicer/MODEL.md, Printer model). The
// weight of offset i is the overlap of [i - 1/2, i + 1/2] with [-w/2, w/2], as an integer. Offsets
// -reach and reach weigh `end`, those between weigh `full`; a box within one voxel has reach 0 and
// weighs `end`.
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

// A voxel of the result is 1 iff the weighted sum over its neighborhood, x.at(dx) * y.at(dy) for
// each voxel that is 1, is at least `least` (> 0). Every pixel of the input is repeat[0] x
// repeat[1] voxels of the result. Outside is powder.
RunLayer box_threshold(const RunLayer& in, std::array<int, 2> repeat, const BoxWeights& x,
                       const BoxWeights& y, std::int64_t least);

// The least weighted sum that is a dose of at least `level` (0 < level <= 1).
std::int64_t min_sum(const BoxWeights& x, const BoxWeights& y, double level);

}  // namespace binderjet
