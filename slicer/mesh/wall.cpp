// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/mesh/wall.h"

#include <cmath>
#include <cstddef>

#include "slicer/mesh/boundary.h"

namespace binderjet {
namespace {

Point minus(const Point& a, const Point& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }

// Of each point: the sum of its faces' normals, weighted by their areas.
std::vector<Point> normals(const Mesh& mesh) {
  std::vector<Point> sums(mesh.points.size(), Point{});
  for (const Triangle& t : mesh.triangles) {
    const Point& origin = mesh.points[static_cast<std::size_t>(t[0])];
    const Point a = minus(mesh.points[static_cast<std::size_t>(t[1])], origin);
    const Point b = minus(mesh.points[static_cast<std::size_t>(t[2])], origin);
    const Point normal = {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2],
                          a[0] * b[1] - a[1] * b[0]};
    for (const int corner : t) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        sums[static_cast<std::size_t>(corner)][axis] += normal[axis];
      }
    }
  }
  return sums;
}

}  // namespace

void add_wall(Mesh& mesh, double thickness) {
  const std::vector<DirectedEdge> rim = boundary_edges(mesh);
  const std::vector<Point> outward = normals(mesh);
  const auto behind = [offset = static_cast<int>(mesh.points.size())](int p) { return p + offset; };
  const std::size_t points = mesh.points.size();
  const std::size_t triangles = mesh.triangles.size();
  for (std::size_t p = 0; p < points; ++p) {
    const Point& normal = outward[p];
    const double length = std::hypot(normal[0], normal[1], normal[2]);
    Point back = mesh.points[p];
    for (std::size_t axis = 0; axis < 3 && length > 0; ++axis) {
      back[axis] -= thickness * normal[axis] / length;
    }
    mesh.points.push_back(back);
  }
  for (std::size_t i = 0; i < triangles; ++i) {
    const Triangle t = mesh.triangles[i];
    mesh.triangles.push_back({behind(t[0]), behind(t[2]), behind(t[1])});
  }
  for (const auto& [from, to] : rim) {
    mesh.triangles.push_back({to, from, behind(from)});
    mesh.triangles.push_back({to, behind(from), behind(to)});
  }
}

}  // namespace binderjet
