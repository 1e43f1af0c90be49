// SPDX-License-Identifier: GPL-3.0-or-later
// Streams of blocks of layers, for work that changes several layers together.
//
// Block b holds the layers from b * size - shift, as many as `size`, but for those beyond the job's
// ends. Where blocks begin does not depend on which layers are asked for, so neither does what is
// made of them.
#pragma once

#include <algorithm>
#include <memory>
#include <utility>
#include <vector>

#include "slicer/layers/stream.h"

namespace binderjet {

// shift < size.
struct BlockForm {
  int size = 1;
  int shift = 0;

  // The blocks that hold these layers, and the layers of these blocks, cut at the job's ends.
  LayerRange blocks_of(LayerRange layers) const {
    return {(layers.first + shift) / size, (layers.last + shift + size - 1) / size};
  }
  LayerRange layers_of(LayerRange blocks, int job_layers) const {
    return {std::max(0, blocks.first * size - shift),
            std::min(job_layers, blocks.last * size - shift)};
  }
};

template <class T>
using Block = std::vector<Shared<T>>;

// A stream of layers as blocks; it holds the layers of whole blocks.
template <class T>
class ToBlocks : public Stream<Block<T>> {
 public:
  ToBlocks(std::unique_ptr<Stream<T>> layers, BlockForm form, int job_layers)
      : layers_(std::move(layers)),
        form_(form),
        job_layers_(job_layers),
        rest_(form.blocks_of(layers_->rest())) {}

  LayerRange rest() const override { return rest_; }
  std::vector<Shared<Block<T>>> next(int count) override {
    std::vector<Shared<Block<T>>> out;
    for (; count > 0 && rest_.first < rest_.last; --count, ++rest_.first) {
      const LayerRange own = form_.layers_of({rest_.first, rest_.first + 1}, job_layers_);
      out.push_back(std::make_shared<const Block<T>>(layers_->next(own.size())));
    }
    return out;
  }

 private:
  std::unique_ptr<Stream<T>> layers_;
  BlockForm form_;
  int job_layers_;
  LayerRange rest_;
};

// The layers of a stream of blocks that lie in `layers`.
template <class T>
class FromBlocks : public Stream<T> {
 public:
  FromBlocks(std::unique_ptr<Stream<Block<T>>> blocks, BlockForm form, LayerRange layers,
             int job_layers)
      : blocks_(std::move(blocks)),
        rest_(layers),
        held_first_(form.layers_of(blocks_->rest(), job_layers).first) {}

  LayerRange rest() const override { return rest_; }
  std::vector<Shared<T>> next(int count) override {
    const int last = std::min(rest_.last, rest_.first + count);
    while (held_first_ + static_cast<int>(held_.size()) < last) {
      // One for each core of a small machine.
      for (const Shared<Block<T>>& block : blocks_->next(2)) {
        held_.insert(held_.end(), block->begin(), block->end());
      }
    }
    held_.erase(held_.begin(), held_.begin() + (rest_.first - held_first_));
    const auto end = held_.begin() + (last - rest_.first);
    held_first_ = rest_.first;
    rest_.first = last;
    return {held_.begin(), end};
  }

 private:
  std::unique_ptr<Stream<Block<T>>> blocks_;
  LayerRange rest_;
  int held_first_;
  std::vector<Shared<T>> held_;
};

}  // namespace binderjet
