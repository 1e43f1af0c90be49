// SPDX-License-Identifier: GPL-3.0-or-later
// Layers pulled in order, a block at a time: nobody computes a layer that nobody asked for.
#pragma once

#include <algorithm>
#include <vector>

#include "slicer/layers/window.h"

namespace binderjet {

// Layers first <= k < last.
struct LayerRange {
  int first = 0;
  int last = 0;
  int size() const { return last - first; }
  bool operator==(const LayerRange&) const = default;
};

// `layers` and those within reach of them, cut at the ends of `whole`.
inline LayerRange grown(LayerRange layers, LayerReach reach, LayerRange whole) {
  return {std::max(whole.first, layers.first - reach.below),
          std::min(whole.last, layers.last + reach.above)};
}

template <class T>
class Stream {
 public:
  virtual ~Stream() = default;
  // The layers still to come.
  virtual LayerRange rest() const = 0;
  // The next `count` layers, fewer at the end.
  virtual std::vector<Shared<T>> next(int count) = 0;
};

// Enough layers in flight to keep the cores busy, few enough to keep memory small.
constexpr int kBlockLayers = 8;

}  // namespace binderjet
