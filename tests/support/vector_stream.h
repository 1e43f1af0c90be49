// SPDX-License-Identifier: GPL-3.0-or-later
// Layers that are all there already, as a stream.
#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "slicer/layers/stream.h"

namespace binderjet {

template <class T>
class VectorStream : public Stream<T> {
 public:
  explicit VectorStream(std::vector<Shared<T>> layers)
      : layers_(std::move(layers)), rest_{0, static_cast<int>(layers_.size())} {}
  LayerRange rest() const override { return rest_; }
  std::vector<Shared<T>> next(int count) override {
    std::vector<Shared<T>> out;
    for (; count > 0 && rest_.size() > 0; --count) {
      out.push_back(layers_[static_cast<std::size_t>(rest_.first++)]);
    }
    return out;
  }

 private:
  std::vector<Shared<T>> layers_;
  LayerRange rest_;
};

template <class T>
std::unique_ptr<Stream<T>> stream_of(std::vector<Shared<T>> layers) {
  return std::make_unique<VectorStream<T>>(std::move(layers));
}

}  // namespace binderjet
