// SPDX-License-Identifier: GPL-3.0-or-later
// Models that the tests make themselves, closed and oriented, in millimeters.
#pragma once

#include <cmath>
#include <fstream>
#include <string>
#include <utility>

#include "slicer/coupon/coupon_shapes.h"
#include "slicer/mesh/mesh.h"

namespace binderjet::models {

inline Mesh box(Point low, Point high) {
  Mesh mesh;
  for (int corner = 0; corner < 8; ++corner) {
    mesh.points.push_back({(corner & 1) != 0 ? high[0] : low[0],
                           (corner & 2) != 0 ? high[1] : low[1],
                           (corner & 4) != 0 ? high[2] : low[2]});
  }
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return mesh;
}

inline Mesh inside_out(Mesh mesh) {
  for (Triangle& triangle : mesh.triangles) std::swap(triangle[1], triangle[2]);
  return mesh;
}

inline Mesh joined(Mesh mesh, const Mesh& other) {
  const int base = static_cast<int>(mesh.points.size());
  mesh.points.insert(mesh.points.end(), other.points.begin(), other.points.end());
  for (const Triangle& t : other.triangles) {
    mesh.triangles.push_back({t[0] + base, t[1] + base, t[2] + base});
  }
  return mesh;
}

// A sphere cut from an octahedron, `rounds` times halved; radius(direction) may vary.
template <class Radius>
Mesh blob(int rounds, Radius radius) {
  Mesh mesh;
  mesh.points = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  mesh.triangles = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4},
                    {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
  for (int round = 0; round < rounds; ++round) split_unit_ball(mesh);
  for (Point& point : mesh.points) {
    const double r = radius(point);
    for (double& value : point) value *= r;
  }
  return mesh;
}

inline Mesh sphere(double radius_mm, int rounds = 5) {
  return blob(rounds, [radius_mm](const Point&) { return radius_mm; });
}

// A ball with round dimples, the detail that the paper's Fig. 10 loses.
inline Mesh golf_ball(double radius_mm, int rounds = 6) {
  constexpr int kDimples = 250;
  constexpr double kGoldenAngle = 2.399963229728653;
  std::vector<Point> centers;
  for (int i = 0; i < kDimples; ++i) {
    const double z = 1 - (2 * i + 1.0) / kDimples;
    const double r = std::sqrt(1 - z * z);
    centers.push_back({r * std::cos(i * kGoldenAngle), r * std::sin(i * kGoldenAngle), z});
  }
  return blob(rounds, [&](const Point& p) {
    double nearest = -1;
    for (const Point& c : centers) {
      nearest = std::max(nearest, p[0] * c[0] + p[1] * c[1] + p[2] * c[2]);
    }
    const double angle = std::acos(std::min(1.0, nearest));
    constexpr double kDimple = 0.11;
    if (angle >= kDimple) return radius_mm;
    const double t = angle / kDimple;
    return radius_mm * (1 - 0.025 * (1 - t * t));
  });
}

inline Mesh shifted(Mesh mesh, Point by) {
  for (Point& point : mesh.points) {
    for (std::size_t axis = 0; axis < 3; ++axis) point[axis] += by[axis];
  }
  return mesh;
}

// Moved so that the lower corner of its box is at (0, 0, 0), as placement does.
inline Mesh at_origin(Mesh mesh) {
  const Box bounds = bounding_box(mesh);
  return shifted(std::move(mesh), {-bounds.min[0], -bounds.min[1], -bounds.min[2]});
}

inline void write_obj(const Mesh& mesh, const std::string& path) {
  std::ofstream file(path);
  file.precision(17);
  for (const Point& p : mesh.points) file << "v " << p[0] << ' ' << p[1] << ' ' << p[2] << '\n';
  for (const Triangle& t : mesh.triangles) {
    file << "f " << t[0] + 1 << ' ' << t[1] + 1 << ' ' << t[2] + 1 << '\n';
  }
}

}  // namespace binderjet::models
