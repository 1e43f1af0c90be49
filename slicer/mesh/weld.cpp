// SPDX-License-Identifier: GPL-3.0-or-later
// Welding by hashing the bits of the three coordinates.
#include "slicer/mesh/weld.h"

#include <bit>
#include <cstdint>

namespace binderjet {

std::size_t PointWelder::slot(const Point& point) const {
  std::uint64_t hash = 0;
  for (const double value : point) {
    // Adding zero turns -0 into 0, which is equal to it.
    hash = (hash ^ std::bit_cast<std::uint64_t>(value + 0.0)) * 0x9E3779B97F4A7C15u;
    hash ^= hash >> 32;
  }
  const std::size_t mask = table_.size() - 1;
  std::size_t place = static_cast<std::size_t>(hash) & mask;
  while (table_[place] >= 0 && points_[static_cast<std::size_t>(table_[place])] != point) {
    place = (place + 1) & mask;
  }
  return place;
}

void PointWelder::grow() {
  const std::size_t size = table_.empty() ? 1024 : table_.size() * 2;
  table_ = std::vector<int>();  // the old table goes before the new one comes
  table_.assign(size, -1);
  for (std::size_t i = 0; i < points_.size(); ++i) table_[slot(points_[i])] = static_cast<int>(i);
}

int PointWelder::add(const Point& point) {
  if (points_.size() * 2 >= table_.size()) grow();
  int& index = table_[slot(point)];
  if (index < 0) {
    index = static_cast<int>(points_.size());
    points_.push_back(point);
  }
  return index;
}

int weld_points(Mesh& mesh) {
  PointWelder welder;
  std::vector<int> merged;
  merged.reserve(mesh.points.size());
  for (const Point& point : mesh.points) merged.push_back(welder.add(point));
  const std::size_t before = mesh.points.size();
  mesh.points = welder.take();
  for (Triangle& triangle : mesh.triangles) {
    for (int& corner : triangle) corner = merged[static_cast<std::size_t>(corner)];
  }
  return static_cast<int>(before - mesh.points.size());
}

}  // namespace binderjet
