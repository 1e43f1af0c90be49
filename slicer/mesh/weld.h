// SPDX-License-Identifier: GPL-3.0-or-later
// Points by value: equal coordinates become one point, in the order of first appearance.
#pragma once

#include <cstddef>
#include <vector>

#include "slicer/mesh/mesh.h"

namespace binderjet {

// An open-addressed table of indices beside the points: 8 to 16 bytes a point, where a std::map
// takes 90 and more.
class PointWelder {
 public:
  // The index of the point with exactly these coordinates (0 equals -0). Coordinates must not be
  // NaN.
  int add(const Point& point);

  std::vector<Point> take() { return std::move(points_); }

 private:
  void grow();
  std::size_t slot(const Point& point) const;

  std::vector<Point> points_;
  std::vector<int> table_;  // -1 is free; the size is a power of two
};

// Merges points with equal coordinates and returns how many went. Triangles keep their order.
int weld_points(Mesh& mesh);

}  // namespace binderjet
