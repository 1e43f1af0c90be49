// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/coupon/coupon_shapes.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace binderjet {

void add_box(Mesh& mesh, const Point& low, const Point& high) {
  const int base = static_cast<int>(mesh.points.size());
  for (int corner = 0; corner < 8; ++corner) {
    mesh.points.push_back({(corner & 1) != 0 ? high[0] : low[0],
                           (corner & 2) != 0 ? high[1] : low[1],
                           (corner & 4) != 0 ? high[2] : low[2]});
  }
  constexpr std::array<Triangle, 12> kFaces = {{{0, 2, 1},
                                                {1, 2, 3},
                                                {4, 5, 6},
                                                {5, 7, 6},
                                                {0, 1, 4},
                                                {1, 5, 4},
                                                {2, 6, 3},
                                                {3, 6, 7},
                                                {0, 4, 2},
                                                {2, 4, 6},
                                                {1, 3, 5},
                                                {3, 7, 5}}};
  for (const Triangle& t : kFaces) {
    mesh.triangles.push_back({t[0] + base, t[1] + base, t[2] + base});
  }
}

void add_turned(Mesh& mesh, Point low, Point high, bool along_y) {
  if (along_y) {
    std::swap(low[0], low[1]);
    std::swap(high[0], high[1]);
  }
  add_box(mesh, low, high);
}

void add_prism(Mesh& mesh, const std::array<Point, 3>& base, const Point& way) {
  const int first = static_cast<int>(mesh.points.size());
  Point u{};
  Point v{};
  for (std::size_t i = 0; i < 3; ++i) {
    u[i] = base[1][i] - base[0][i];
    v[i] = base[2][i] - base[0][i];
  }
  const double along = way[0] * (u[1] * v[2] - u[2] * v[1]) + way[1] * (u[2] * v[0] - u[0] * v[2]) +
                       way[2] * (u[0] * v[1] - u[1] * v[0]);
  for (const Point& p : base) mesh.points.push_back(p);
  for (const Point& p : base) {
    mesh.points.push_back({p[0] + way[0], p[1] + way[1], p[2] + way[2]});
  }
  constexpr std::array<Triangle, 8> kFaces = {
      {{0, 2, 1}, {3, 4, 5}, {0, 1, 4}, {0, 4, 3}, {1, 2, 5}, {1, 5, 4}, {2, 0, 3}, {2, 3, 5}}};
  for (const Triangle& t : kFaces) {
    // The faces are seen from outside if the base turns counter-clockwise around the way.
    const auto [a, b, c] = t;
    mesh.triangles.push_back(along > 0 ? Triangle{a + first, b + first, c + first}
                                       : Triangle{a + first, c + first, b + first});
  }
}

void split_unit_ball(Mesh& mesh) {
  std::map<std::pair<int, int>, int> middles;
  const auto middle = [&](int a, int b) {
    const auto [place, added] = middles.try_emplace(std::minmax(a, b), 0);
    if (added) {
      Point m{};
      double square = 0;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        m[axis] = mesh.points[static_cast<std::size_t>(a)][axis] +
                  mesh.points[static_cast<std::size_t>(b)][axis];
        square += m[axis] * m[axis];
      }
      for (double& value : m) value /= std::sqrt(square);
      place->second = static_cast<int>(mesh.points.size());
      mesh.points.push_back(m);
    }
    return place->second;
  };
  std::vector<Triangle> finer;
  for (const Triangle& t : mesh.triangles) {
    const int ab = middle(t[0], t[1]);
    const int bc = middle(t[1], t[2]);
    const int ca = middle(t[2], t[0]);
    finer.insert(finer.end(), {{t[0], ab, ca}, {ab, t[1], bc}, {ca, bc, t[2]}, {ab, bc, ca}});
  }
  mesh.triangles = std::move(finer);
}

}  // namespace binderjet
