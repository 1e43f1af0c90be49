// SPDX-License-Identifier: GPL-3.0-or-later
// A bounded queue of encoded layers between the thread that computes and the one that sends.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <exception>
#include <mutex>
#include <utility>
#include <vector>

namespace binderjet {

class LayerQueue {
 public:
  using Layer = std::vector<std::byte>;

  explicit LayerQueue(std::size_t room) : room_(room) {}

  // Waits for room: who takes slowly holds up who computes. False once nobody takes any more.
  bool push(Layer layer) {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return layers_.size() < room_ || closed_; });
    if (closed_) return false;
    layers_.push_back(std::move(layer));
    changed_.notify_all();
    return true;
  }
  // The error is thrown by pop() once the layers before it are taken.
  void fail(std::exception_ptr error) {
    const std::lock_guard lock(mutex_);
    error_ = std::move(error);
    changed_.notify_all();
  }
  // As many layers are popped as are pushed.
  Layer pop() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return !layers_.empty() || error_; });
    if (layers_.empty()) std::rethrow_exception(error_);
    Layer layer = std::move(layers_.front());
    layers_.pop_front();
    changed_.notify_all();
    return layer;
  }
  void close() {
    const std::lock_guard lock(mutex_);
    closed_ = true;
    changed_.notify_all();
  }

 private:
  const std::size_t room_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Layer> layers_;
  std::exception_ptr error_;
  bool closed_ = false;
};

}  // namespace binderjet
