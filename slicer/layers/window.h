// SPDX-License-Identifier: GPL-3.0-or-later
// A layer with those around it, each by its offset: 0 is the middle one, -1 the one below. Null
// stands for what lies beyond the job's ends, and is powder.
//
//   offset   -2 -1  0  1  2      reach {2, 2}; where layer 0 of a job is the middle one,
//   layer     -  -  0  1  2      at(-2) and at(-1) are null
#pragma once

#include <cassert>
#include <cstdlib>
#include <initializer_list>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "slicer/layers/run_layer.h"

namespace binderjet {

// Layers are shared between the steps that still look at them, and never change once made.
template <class T>
using Shared = std::shared_ptr<const T>;

// How many layers below a layer and above it are looked at.
struct LayerReach {
  int below = 0;
  int above = 0;

  static LayerReach both_sides(int layers) { return {layers, layers}; }
  int count() const { return below + 1 + above; }
  bool operator==(const LayerReach&) const = default;
};

// What a step sees of the layers before it. A view: the layers must outlive it.
template <class T>
class Window {
 public:
  // From the lowest layer to the highest.
  Window(std::span<const Shared<T>> layers, LayerReach reach) : layers_(layers), reach_(reach) {
    assert(static_cast<int>(layers.size()) == reach.count());
  }
  // An odd number of layers.
  Window(const std::vector<Shared<T>>& layers)
      : Window(layers, LayerReach::both_sides(static_cast<int>(layers.size() / 2))) {}

  LayerReach reach() const { return reach_; }
  // `offset` is within the reach.
  const Shared<T>& shared(int offset) const {
    assert(-reach_.below <= offset && offset <= reach_.above);
    return layers_[static_cast<std::size_t>(reach_.below + offset)];
  }
  const T* at(int offset) const { return shared(offset).get(); }
  // A step is only asked for layers of the job, so the middle one is always there.
  const T& middle() const {
    assert(at(0) != nullptr);
    return *at(0);
  }

 private:
  std::span<const Shared<T>> layers_;
  LayerReach reach_;
};

// Layers of bits that somebody else holds, as many below the middle one as above: the masks that a
// layer's print depends on, or the printed layers that wear takes.
class RunWindow {
 public:
  // An odd number of layers, from the lowest to the highest.
  RunWindow(std::vector<const RunLayer*> layers) : layers_(std::move(layers)) {
    assert(layers_.size() % 2 == 1);
  }
  RunWindow(std::initializer_list<const RunLayer*> layers)
      : RunWindow(std::vector<const RunLayer*>(layers)) {}

  // `layer_of`(offset) for all offsets within `reach`, from the lowest on.
  template <class LayerOf>
  static RunWindow around(int reach, const LayerOf& layer_of) {
    std::vector<const RunLayer*> layers;
    layers.reserve(2 * static_cast<std::size_t>(reach) + 1);
    for (int offset = -reach; offset <= reach; ++offset) layers.push_back(layer_of(offset));
    return layers;
  }

  int reach() const { return static_cast<int>(layers_.size() / 2); }
  // |offset| <= reach().
  const RunLayer* at(int offset) const {
    assert(std::abs(offset) <= reach());
    return layers_[static_cast<std::size_t>(reach() + offset)];
  }
  // Must not be null.
  const RunLayer& middle() const {
    assert(at(0) != nullptr);
    return *at(0);
  }
  // The window around the layer at `offset`; it must lie within this one.
  RunWindow part(int offset, int part_reach) const {
    return around(part_reach, [&](int from_there) { return at(offset + from_there); });
  }

  // From the lowest layer to the highest.
  auto begin() const { return layers_.begin(); }
  auto end() const { return layers_.end(); }

 private:
  std::vector<const RunLayer*> layers_;
};

// The bits around the middle layer of a window: `bits_of`(layer) of each layer that is there.
template <class T, class BitsOf>
RunWindow runs_around(const Window<T>& layers, int reach, const BitsOf& bits_of) {
  return RunWindow::around(reach, [&](int offset) -> const RunLayer* {
    const T* layer = layers.at(offset);
    return layer == nullptr ? nullptr : bits_of(*layer);
  });
}
// The same around layers[index] of layers that are all there; beyond their ends is null.
template <class Layers, class BitsOf>
RunWindow runs_around(const Layers& layers, int index, int reach, const BitsOf& bits_of) {
  return RunWindow::around(reach, [&](int offset) -> const RunLayer* {
    const int k = index + offset;
    const bool there = k >= 0 && k < static_cast<int>(layers.size());
    return there ? bits_of(layers[static_cast<std::size_t>(k)]) : nullptr;
  });
}
inline RunWindow runs_around(const std::vector<RunLayer>& layers, int index, int reach) {
  return runs_around(layers, index, reach, [](const RunLayer& one) { return &one; });
}
inline RunWindow runs_around(const std::vector<Shared<RunLayer>>& layers, int index, int reach) {
  return runs_around(layers, index, reach, [](const Shared<RunLayer>& one) { return one.get(); });
}

}  // namespace binderjet
