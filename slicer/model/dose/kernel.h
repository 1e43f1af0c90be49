// SPDX-License-Identifier: GPL-3.0-or-later
// A one-dimensional kernel of whole weights: where along an axis the binder of one voxel ends up.
//
//   first = -1, weights 1 2 1:  a quarter lands one voxel below, half stays, a quarter lands above
//
// A kernel of two dimensions is a product of two of these. That covers boxes and gaussians, and its
// cost is the sum of both lengths instead of their product.
#pragma once

#include <cstdint>
#include <numeric>
#include <optional>
#include <vector>

#include "slicer/model/dose/box_filter.h"

namespace binderjet {

// weights[i] is the share of a voxel's binder that lands first + i voxels further along the axis.
// Only ratios matter. The default moves nothing.
struct Kernel {
  int first = 0;
  std::vector<std::int64_t> weights{1};

  int last() const { return first + static_cast<int>(weights.size()) - 1; }
  std::int64_t total() const {
    return std::accumulate(weights.begin(), weights.end(), std::int64_t{0});
  }
  std::int64_t at(int offset) const {
    return offset < first || offset > last() ? 0
                                             : weights[static_cast<std::size_t>(offset - first)];
  }
  bool operator==(const Kernel&) const = default;
};

Kernel box_kernel(const BoxWeights& box);

// A centered normal distribution of this full width at half maximum (> 0), each weight the integral
// over its voxel. The tails are cut where 2^-12 of the binder lies beyond on both sides together,
// a dose far below any that binds powder.
Kernel gaussian_kernel(double width_vx);

// The kernel as the box that it is, if it is one: box_threshold() is faster than any other way.
std::optional<BoxWeights> as_box(const Kernel& kernel);

}  // namespace binderjet
