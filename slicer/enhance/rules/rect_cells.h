// SPDX-License-Identifier: GPL-3.0-or-later
// A piece of a layer as a byte per cell, for work that looks at every cell near the boundary.
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

#include "slicer/layers/run_layer.h"

namespace binderjet {

// Cells x0 <= x < x1, y0 <= y < y1; may reach beyond the layer.
struct Rect {
  int x0 = 0;
  int y0 = 0;
  int x1 = 0;
  int y1 = 0;

  int width() const { return x1 - x0; }
  int height() const { return y1 - y0; }
  bool empty() const { return x0 >= x1 || y0 >= y1; }
  bool holds(int x, int y) const { return x >= x0 && x < x1 && y >= y0 && y < y1; }
  Rect grown(int dx, int dy) const { return {x0 - dx, y0 - dy, x1 + dx, y1 + dy}; }
  Rect joined(const Rect& with) const {
    return {std::min(x0, with.x0), std::min(y0, with.y0), std::max(x1, with.x1),
            std::max(y1, with.y1)};
  }
  Rect cut(const Rect& to) const {
    return {std::max(x0, to.x0), std::max(y0, to.y0), std::min(x1, to.x1), std::min(y1, to.y1)};
  }
};

// Row-major cells of a rectangle.
template <class T>
class Plane {
 public:
  Plane() = default;
  explicit Plane(const Rect& rect, T value = {}) { reset(rect, value); }

  void reset(const Rect& rect, T value) {
    rect_ = rect;
    cells_.assign(static_cast<std::size_t>(rect.width()) * static_cast<std::size_t>(rect.height()),
                  value);
  }
  const Rect& rect() const { return rect_; }
  int stride() const { return rect_.width(); }
  T* at(int x, int y) { return cells_.data() + place(x, y); }
  const T* at(int x, int y) const { return cells_.data() + place(x, y); }

 private:
  std::size_t place(int x, int y) const {
    return static_cast<std::size_t>(y - rect_.y0) * static_cast<std::size_t>(rect_.width()) +
           static_cast<std::size_t>(x - rect_.x0);
  }

  Rect rect_;
  std::vector<T> cells_;
};

// Adds `value` to every cell of `plane` that is 1 in the layer.
template <class T>
void add_layer(const RunLayer& layer, T value, Plane<T>& plane) {
  const Rect& rect = plane.rect();
  for (int y = rect.y0; y < rect.y1; ++y) {
    const std::span<const int> row = layer.row(y);
    for (std::size_t i = 0; i < row.size() && row[i] < rect.x1; i += 2) {
      const int begin = std::max(row[i], rect.x0);
      const int end = std::min(row[i + 1], rect.x1);
      T* cell = plane.at(rect.x0, y) - rect.x0;
      for (int x = begin; x < end; ++x) cell[x] = static_cast<T>(cell[x] + value);
    }
  }
}

// The cells of a rectangle at (0, 0) as a layer: 1 where they are not 0.
template <class T>
RunLayer to_layer(const Plane<T>& plane, int width, int height) {
  RunLayer out(width);
  for (int y = 0; y < height; ++y) {
    const T* row = plane.at(0, y);
    out.append_row_where([row](int x) { return row[x] != 0; });
  }
  return out;
}

}  // namespace binderjet
