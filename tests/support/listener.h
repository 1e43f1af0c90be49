// SPDX-License-Identifier: GPL-3.0-or-later
// Who listens to long work in a test.
#pragma once

#include <functional>
#include <string>

#include "slicer/base/work.h"

namespace binderjet {

struct Listener : WorkListener {
  std::function<void()> on_check;  // also at each advance
  std::function<void(const std::string&)> on_note;

  void check() override {
    if (on_check) on_check();
  }
  void begun(const Stage&) override {}
  void advanced(const Stage&) override { check(); }
  void ended(const Stage&) noexcept override {}
  void note(const std::string& text) override {
    if (on_note) on_note(text);
  }
};

}  // namespace binderjet
