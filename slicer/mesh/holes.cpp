// SPDX-License-Identifier: GPL-3.0-or-later
// Boundary edges strung into simple cycles; lids by CGAL, or fans where those are smaller.
#include "slicer/mesh/holes.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/triangulate_hole.h>

#include <algorithm>
#include <exception>
#include <unordered_map>
#include <vector>

#include "slicer/mesh/boundary.h"

namespace binderjet {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

// CGAL's search is cubic in the worst case; a longer hole gets a fan.
constexpr std::size_t kLongestSearch = 200;

// Walks along the edges; whenever the walk meets itself, the loop is cut off as a cycle.
std::vector<std::vector<int>> boundary_cycles(const std::vector<DirectedEdge>& edges) {
  std::unordered_map<int, std::vector<int>> next;
  for (const DirectedEdge& edge : edges) next[edge[0]].push_back(edge[1]);
  std::vector<std::vector<int>> cycles;
  std::unordered_map<int, std::size_t> place;  // of a point in the walk
  for (const DirectedEdge& edge : edges) {
    std::vector<int> walk;
    place.clear();
    int point = edge[0];
    while (true) {
      const auto met = place.find(point);
      if (met != place.end()) {
        const auto loop = walk.begin() + static_cast<std::ptrdiff_t>(met->second);
        cycles.emplace_back(loop, walk.end());
        for (auto gone = loop; gone != walk.end(); ++gone) place.erase(*gone);
        walk.erase(loop, walk.end());
      }
      std::vector<int>& ways = next[point];
      if (ways.empty()) break;  // only where the walk began, for as many edges end as begin
      place[point] = walk.size();
      walk.push_back(point);
      point = ways.back();
      ways.pop_back();
    }
  }
  return cycles;
}

std::vector<Triangle> smooth_lid(const Mesh& mesh, const std::vector<int>& cycle) {
  std::vector<Kernel::Point_3> line;
  for (const int index : cycle) {
    const Point& p = mesh.points[static_cast<std::size_t>(index)];
    line.emplace_back(p[0], p[1], p[2]);
  }
  std::vector<CGAL::Triple<int, int, int>> found;
  try {
    CGAL::Polygon_mesh_processing::triangulate_hole_polyline(
        line, std::back_inserter(found), CGAL::parameters::use_delaunay_triangulation(true));
  } catch (const std::exception&) {
    return {};  // degenerate points; the fan takes them
  }
  std::vector<Triangle> lid;
  if (found.size() + 2 != cycle.size()) return lid;
  for (const auto& triple : found) {
    // In the order of the cycle, every triangle of a lid runs along with it.
    std::array<int, 3> corners = {triple.first, triple.second, triple.third};
    std::sort(corners.begin(), corners.end());
    for (int& corner : corners) corner = cycle[static_cast<std::size_t>(corner)];
    lid.push_back(corners);
  }
  return lid;
}

std::vector<Triangle> fan(const std::vector<int>& cycle, int center) {
  std::vector<Triangle> lid;
  for (std::size_t i = 0; i < cycle.size(); ++i) {
    lid.push_back({cycle[i], cycle[(i + 1) % cycle.size()], center});
  }
  return lid;
}

Point centroid(const Mesh& mesh, const std::vector<int>& cycle) {
  Point sum{};
  for (const int index : cycle) {
    for (std::size_t i = 0; i < 3; ++i) sum[i] += mesh.points[static_cast<std::size_t>(index)][i];
  }
  for (double& value : sum) value /= static_cast<double>(cycle.size());
  return sum;
}

double area_of(const Mesh& mesh, const std::vector<Triangle>& lid) {
  double sum = 0;
  for (const Triangle& triangle : lid) sum += triangle_area(mesh, triangle);
  return sum;
}

// The smaller of what CGAL finds (it looks at the angles first, and may fold) and the fan.
double close_cycle(Mesh& mesh, const std::vector<int>& cycle) {
  std::vector<Triangle> lid;
  if (cycle.size() == 3) {
    lid = {{cycle[0], cycle[1], cycle[2]}};
  } else if (cycle.size() <= kLongestSearch) {
    lid = smooth_lid(mesh, cycle);
  }
  double area = area_of(mesh, lid);
  if (cycle.size() > 3) {
    mesh.points.push_back(centroid(mesh, cycle));
    std::vector<Triangle> other = fan(cycle, static_cast<int>(mesh.points.size()) - 1);
    const double other_area = area_of(mesh, other);
    if (lid.empty() || other_area < area) {
      lid = std::move(other);
      area = other_area;
    } else {
      mesh.points.pop_back();
    }
  }
  mesh.triangles.insert(mesh.triangles.end(), lid.begin(), lid.end());
  return area;
}

}  // namespace

ClosedHoles close_holes(Mesh& mesh) {
  ClosedHoles result;
  for (std::vector<int>& cycle : boundary_cycles(boundary_edges(mesh))) {
    ++result.holes;
    result.edges += static_cast<std::int64_t>(cycle.size());
    std::reverse(cycle.begin(), cycle.end());  // the lid runs against the edges it closes
    result.area += close_cycle(mesh, cycle);
  }
  return result;
}

}  // namespace binderjet
