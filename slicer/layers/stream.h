// SPDX-License-Identifier: GPL-3.0-or-later
// Layers pulled in order, a block at a time: nobody computes a layer that nobody asked for.
//
// A step is a pure function of a window of its upstream's layers. The layers of a block are
// computed side by side on all cores; since each depends on nothing but its window, neither the
// block size nor the number of threads changes a bit. A step owns a ring of the layers it still
// needs, so memory does not depend on the height of the part.
#pragma once

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cassert>
#include <deque>
#include <functional>
#include <memory>
#include <span>
#include <utility>
#include <vector>

namespace binderjet {

// Layers are shared between the steps that still look at them, and never change once made.
template <class T>
using Shared = std::shared_ptr<const T>;

// Layers first <= k < last.
struct LayerRange {
  int first = 0;
  int last = 0;
  int size() const { return last - first; }
};

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

// Out(k) = make(k, window), window = In(k - reach) ... In(k + reach); null beyond the job's ends
// or, where only a piece of the job is there, beyond that piece.
template <class In, class Out>
class Step : public Stream<Out> {
 public:
  using Window = std::span<const Shared<In>>;
  using Make = std::function<Out(int layer, Window)>;

  // The upstream must begin `reach` layers before `layers` and end as much after, or where `job`
  // begins and ends.
  Step(std::unique_ptr<Stream<In>> upstream, LayerRange layers, int reach, LayerRange job,
       Make make)
      : upstream_(std::move(upstream)),
        rest_(layers),
        reach_(reach),
        job_(job),
        held_first_(upstream_->rest().first),
        make_(std::move(make)) {
    assert(held_first_ <= std::max(job.first, layers.first - reach));
    assert(upstream_->rest().last >= std::min(job.last, layers.last + reach));
  }
  Step(std::unique_ptr<Stream<In>> upstream, LayerRange layers, int reach, int job_layers,
       Make make)
      : Step(std::move(upstream), layers, reach, LayerRange{0, job_layers}, std::move(make)) {}

  LayerRange rest() const override { return rest_; }

  std::vector<Shared<Out>> next(int count) override {
    const int first = rest_.first;
    const int last = std::min(rest_.last, first + count);
    pull_until(std::min(job_.last, last + reach_));
    std::vector<Shared<Out>> out(static_cast<std::size_t>(last - first));
    oneapi::tbb::parallel_for(first, last, [&](int layer) {
      std::vector<Shared<In>> window;
      for (int k = layer - reach_; k <= layer + reach_; ++k) window.push_back(held(k));
      out[static_cast<std::size_t>(layer - first)] =
          std::make_shared<const Out>(make_(layer, window));
    });
    rest_.first = last;
    while (!held_.empty() && held_first_ < last - reach_) {
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
  int reach_;
  LayerRange job_;
  int held_first_;
  std::deque<Shared<In>> held_;
  Make make_;
};

// `layers` grown by `reach` and cut at the job's ends: what a step needs from its upstream.
inline LayerRange grown(LayerRange layers, int reach, int job_layers) {
  return {std::max(0, layers.first - reach), std::min(job_layers, layers.last + reach)};
}

}  // namespace binderjet
