// SPDX-License-Identifier: GPL-3.0-or-later
// Whether all cells of a rectangle of a plane have the same value, at one cost for any rectangle.
//
// Cells of a rectangle are alike iff no cell differs from the one beside it. So the plane keeps two
// tables of sums: how many cells up to (x, y) differ from the cell below, and from the cell to the
// left. The count within a rectangle is then four reads of each table.
#pragma once

#include "slicer/enhance/rules/rect_cells.h"

namespace binderjet {

class ChangeCount {
 public:
  explicit ChangeCount(const Plane<int>& plane) : across_(plane.rect()), along_(plane.rect()) {
    const Rect& rect = plane.rect();
    for (int y = rect.y0; y < rect.y1; ++y) {
      int across = 0;
      int along = 0;
      for (int x = rect.x0; x < rect.x1; ++x) {
        const int value = *plane.at(x, y);
        across += static_cast<int>(y > rect.y0 && *plane.at(x, y - 1) != value);
        along += static_cast<int>(x > rect.x0 && *plane.at(x - 1, y) != value);
        *across_.at(x, y) = across + (y > rect.y0 ? *across_.at(x, y - 1) : 0);
        *along_.at(x, y) = along + (y > rect.y0 ? *along_.at(x, y - 1) : 0);
      }
    }
  }

  // `rect` is not empty and lies within the plane.
  bool uniform(const Rect& rect) const {
    return count(across_, {rect.x0, rect.y0 + 1, rect.x1, rect.y1}) == 0 &&
           count(along_, {rect.x0 + 1, rect.y0, rect.x1, rect.y1}) == 0;
  }

 private:
  static int count(const Plane<int>& sums, const Rect& rect) {
    if (rect.empty()) return 0;
    const auto up_to = [&](int x, int y) {
      return x < sums.rect().x0 || y < sums.rect().y0 ? 0 : *sums.at(x, y);
    };
    return up_to(rect.x1 - 1, rect.y1 - 1) - up_to(rect.x0 - 1, rect.y1 - 1) -
           up_to(rect.x1 - 1, rect.y0 - 1) + up_to(rect.x0 - 1, rect.y0 - 1);
  }

  Plane<int> across_;  // up to each cell, how many differ from the cell below
  Plane<int> along_;   // up to each cell, how many differ from the cell to the left
};

}  // namespace binderjet
