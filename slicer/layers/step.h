// SPDX-License-Identifier: GPL-3.0-or-later
// One step of a pipeline: a pure function of a window of the layers before it.
//
//   before   ... 3 [4  5  6  7] ...      held: a ring of what is still looked at
//   after    ...       5  6              asked for, with a reach of 1
//
// The layers asked for at once are computed side by side on all cores; since each depends on
// nothing but its window, neither their number nor the number of threads changes a bit. Memory is
// the ring, so it does not depend on the height of the part.
#pragma once

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cassert>
#include <deque>
#include <functional>
#include <memory>
#include <utility>
#include <vector>

#include "slicer/layers/stream.h"

namespace binderjet {

// After(k) = make(k, window of the layers before, around k). Pipelines build their steps; who
// builds one by hand computes by hand what it needs from upstream.
template <class In, class Out>
class Step : public Stream<Out> {
 public:
  using Make = std::function<Out(int layer, const Window<In>&)>;

  // Upstream must hold `layers` grown by `reach` and cut at the ends of `job`; beyond these ends,
  // where only a piece of a job is there as well, the window is null.
  Step(std::unique_ptr<Stream<In>> upstream, LayerRange layers, LayerReach reach, LayerRange job,
       Make make)
      : upstream_(std::move(upstream)),
        rest_(layers),
        reach_(reach),
        job_(job),
        held_first_(upstream_->rest().first),
        make_(std::move(make)) {
    assert(held_first_ <= grown(layers, reach, job).first);
    assert(upstream_->rest().last >= grown(layers, reach, job).last);
  }

  LayerRange rest() const override { return rest_; }

  std::vector<Shared<Out>> next(int count) override {
    const int first = rest_.first;
    const int last = std::min(rest_.last, first + count);
    pull_until(std::min(job_.last, last + reach_.above));
    std::vector<Shared<Out>> out(static_cast<std::size_t>(last - first));
    oneapi::tbb::parallel_for(first, last, [&](int layer) {
      std::vector<Shared<In>> near;
      for (int k = layer - reach_.below; k <= layer + reach_.above; ++k) near.push_back(held(k));
      out[static_cast<std::size_t>(layer - first)] =
          std::make_shared<const Out>(make_(layer, Window<In>(near, reach_)));
    });
    rest_.first = last;
    while (!held_.empty() && held_first_ < last - reach_.below) {
      held_.pop_front();
      ++held_first_;
    }
    return out;
  }

 private:
  void pull_until(int last) {
    const int have = held_first_ + static_cast<int>(held_.size());
    if (last <= have) return;
    for (Shared<In>& layer : upstream_->next(last - have)) held_.push_back(std::move(layer));
  }
  Shared<In> held(int layer) const {
    if (layer < job_.first || layer >= job_.last) return nullptr;
    return held_[static_cast<std::size_t>(layer - held_first_)];
  }

  std::unique_ptr<Stream<In>> upstream_;
  LayerRange rest_;
  LayerReach reach_;
  LayerRange job_;
  int held_first_;
  std::deque<Shared<In>> held_;
  Make make_;
};

}  // namespace binderjet
