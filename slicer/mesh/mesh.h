// SPDX-License-Identifier: GPL-3.0-or-later
// A triangle mesh: shared points and counter-clockwise triangles seen from outside.
#pragma once

#include <algorithm>
#include <array>
#include <limits>
#include <vector>

namespace binderjet {

using Point = std::array<double, 3>;  // x, y, z
using Triangle = std::array<int, 3>;  // indices into Mesh::points

struct Mesh {
  std::vector<Point> points;
  std::vector<Triangle> triangles;
};

struct Box {
  Point min{std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity(),
            std::numeric_limits<double>::infinity()};
  Point max{-std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity(),
            -std::numeric_limits<double>::infinity()};

  double size(int axis) const { return max[axis] - min[axis]; }
};

// The box of the points that triangles use; empty (min > max) without triangles.
inline Box bounding_box(const Mesh& mesh) {
  Box box;
  for (const Triangle& triangle : mesh.triangles) {
    for (int corner : triangle) {
      for (int axis = 0; axis < 3; ++axis) {
        const double value = mesh.points[static_cast<std::size_t>(corner)][axis];
        box.min[axis] = std::min(box.min[axis], value);
        box.max[axis] = std::max(box.max[axis], value);
      }
    }
  }
  return box;
}

}  // namespace binderjet
