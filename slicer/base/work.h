// SPDX-License-Identifier: GPL-3.0-or-later
// Long work says what it does and how far it is, and hears when it shall end. Who listens, if
// anybody does, is no matter of the work:
//
//   Stage stage(work, "reading scan", images, "images");
//   for each image { read it; stage.advance(); }         throws where the work shall end
//
// Stages nest. Where nobody listens an advance() costs one atomic addition.
#pragma once

#include <atomic>
#include <cstdint>
#include <string>
#include <utility>

namespace binderjet {

class Stage;

// Hears of long work, from any of its threads.
class WorkListener {
 public:
  virtual ~WorkListener() = default;

  // Called many times a second; may throw to end the work.
  virtual void check() = 0;
  // A stage lives from begun() to ended(), which follow the nesting of stages.
  virtual void begun(const Stage& stage) = 0;
  virtual void advanced(const Stage& stage) = 0;  // throws like check()
  virtual void ended(const Stage& stage) noexcept = 0;
  // A finding on the way that a person may want to read.
  virtual void note(const std::string& text) = 0;
};

// A handle on who listens, to pass down by value; the default is nobody. The listener outlives it.
class Work {
 public:
  Work() = default;
  explicit Work(WorkListener& listener) : listener_(&listener) {}

  WorkListener* listener() const { return listener_; }
  // Throws where the work shall end.
  void check() const {
    if (listener_ != nullptr) listener_->check();
  }
  void note(const std::string& text) const {
    if (listener_ != nullptr) listener_->note(text);
  }

 private:
  WorkListener* listener_ = nullptr;
};

// What is being done, from here to the end of the scope.
class Stage {
 public:
  // `total` units are to come; 0 where nobody knows how many. `before` of them were done earlier
  // and say nothing of the rate.
  Stage(const Work& work, std::string what, std::int64_t total = 0, std::string unit = "",
        std::int64_t before = 0)
      : listener_(work.listener()),
        what_(std::move(what)),
        unit_(std::move(unit)),
        total_(total),
        before_(before),
        done_(before) {
    if (listener_ != nullptr) listener_->begun(*this);
  }
  ~Stage() {
    if (listener_ != nullptr) listener_->ended(*this);
  }
  Stage(const Stage&) = delete;
  Stage& operator=(const Stage&) = delete;

  // So many more are done, or so many in all. Throw where the work shall end.
  void advance(std::int64_t more = 1) {
    done_ += more;
    if (listener_ != nullptr) listener_->advanced(*this);
  }
  void reach(std::int64_t done) {
    done_ = done;
    if (listener_ != nullptr) listener_->advanced(*this);
  }

  const std::string& what() const { return what_; }
  const std::string& unit() const { return unit_; }
  std::int64_t total() const { return total_; }
  std::int64_t before() const { return before_; }
  std::int64_t done() const { return done_; }

 private:
  WorkListener* listener_;
  std::string what_;
  std::string unit_;
  std::int64_t total_;
  std::int64_t before_;
  std::atomic<std::int64_t> done_;
};

}  // namespace binderjet
