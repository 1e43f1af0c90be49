// SPDX-License-Identifier: GPL-3.0-or-later
// Directed edges, sorted into the list of their smaller point, where opposite ones cancel.
#include "slicer/mesh/boundary.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>

namespace binderjet {
namespace {

template <typename Visit>
void for_each_edge(const Mesh& mesh, const Visit& visit) {
  for (const Triangle& t : mesh.triangles) {
    for (std::size_t c = 0; c < 3; ++c) {
      const auto from = static_cast<std::uint32_t>(t[c]);
      const auto to = static_cast<std::uint32_t>(t[(c + 1) % 3]);
      if (from != to) visit(from, to);
    }
  }
}

// Calls visit(low, high, times, faces) for every edge: how often it is left over from the smaller
// point to the larger one (negative: the other way), and how many faces it has.
template <typename Visit>
void for_each_sum(const Mesh& mesh, const Visit& visit) {
  std::vector<std::uint32_t> begin(mesh.points.size() + 1, 0);
  for_each_edge(mesh, [&](std::uint32_t from, std::uint32_t to) { ++begin[std::min(from, to)]; });
  std::uint32_t sum = 0;
  for (std::uint32_t& count : begin) count = sum += count;
  // Twice the larger point, plus 1 where the edge runs towards the smaller one. Filled from the
  // back, so that begin[] ends as what its name says.
  std::vector<std::uint32_t> edges(sum);
  for_each_edge(mesh, [&](std::uint32_t from, std::uint32_t to) {
    edges[--begin[std::min(from, to)]] = std::max(from, to) << 1 | (from > to ? 1u : 0u);
  });
  for (std::size_t low = 0; low + 1 < begin.size(); ++low) {
    const auto first = edges.begin() + begin[low];
    const auto last = edges.begin() + begin[low + 1];
    std::sort(first, last);
    for (auto edge = first; edge != last;) {
      const std::uint32_t high = *edge >> 1;
      int times = 0;
      int faces = 0;
      for (; edge != last && *edge >> 1 == high; ++edge, ++faces) {
        times += (*edge & 1) != 0 ? -1 : 1;
      }
      visit(static_cast<int>(low), static_cast<int>(high), times, faces);
    }
  }
}

}  // namespace

std::vector<DirectedEdge> boundary_edges(const Mesh& mesh) {
  std::vector<DirectedEdge> result;
  for_each_sum(mesh, [&](int low, int high, int times, int) {
    const DirectedEdge edge = times > 0 ? DirectedEdge{low, high} : DirectedEdge{high, low};
    result.insert(result.end(), static_cast<std::size_t>(std::abs(times)), edge);
  });
  return result;
}

EdgeCounts count_edges(const Mesh& mesh) {
  EdgeCounts counts;
  for_each_sum(mesh, [&](int, int, int times, int faces) {
    counts.open += std::abs(times);
    counts.crowded += faces > 2 ? 1 : 0;
  });
  return counts;
}

double signed_volume(const Mesh& mesh) {
  if (mesh.points.empty()) return 0;
  // Seen from a point of the mesh, a part far from the origin loses no digits.
  const Point& o = mesh.points.front();
  double six_times = 0;
  for (const Triangle& t : mesh.triangles) {
    Point a = mesh.points[static_cast<std::size_t>(t[0])];
    Point b = mesh.points[static_cast<std::size_t>(t[1])];
    Point c = mesh.points[static_cast<std::size_t>(t[2])];
    for (std::size_t i = 0; i < 3; ++i) {
      a[i] -= o[i];
      b[i] -= o[i];
      c[i] -= o[i];
    }
    six_times += a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) +
                 a[2] * (b[0] * c[1] - b[1] * c[0]);
  }
  return six_times / 6;
}

double triangle_area(const Mesh& mesh, const Triangle& t) {
  const Point& a = mesh.points[static_cast<std::size_t>(t[0])];
  const Point& b = mesh.points[static_cast<std::size_t>(t[1])];
  const Point& c = mesh.points[static_cast<std::size_t>(t[2])];
  const Point u{b[0] - a[0], b[1] - a[1], b[2] - a[2]};
  const Point v{c[0] - a[0], c[1] - a[1], c[2] - a[2]};
  return 0.5 * std::hypot(u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2],
                          u[0] * v[1] - u[1] * v[0]);
}

double surface_area(const Mesh& mesh) {
  double sum = 0;
  for (const Triangle& triangle : mesh.triangles) sum += triangle_area(mesh, triangle);
  return sum;
}

}  // namespace binderjet
