// SPDX-License-Identifier: GPL-3.0-or-later
// Boundary edges strung into simple cycles; lids of least area by CGAL, fans where it finds none.
#include "slicer/mesh_holes.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/triangulate_hole.h>

#include <algorithm>
#include <exception>
#include <unordered_map>
#include <vector>

#include "slicer/mesh_boundary.h"

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

std::vector<Triangle> lid_of_least_area(const Mesh& mesh, const std::vector<int>& cycle) {
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

std::vector<Triangle> fan(Mesh& mesh, const std::vector<int>& cycle) {
  Point centroid{};
  for (const int index : cycle) {
    for (std::size_t i = 0; i < 3; ++i)
      centroid[i] += mesh.points[static_cast<std::size_t>(index)][i];
  }
  for (double& value : centroid) value /= static_cast<double>(cycle.size());
  const auto center = static_cast<int>(mesh.points.size());
  mesh.points.push_back(centroid);
  std::vector<Triangle> lid;
  for (std::size_t i = 0; i < cycle.size(); ++i) {
    lid.push_back({cycle[i], cycle[(i + 1) % cycle.size()], center});
  }
  return lid;
}

}  // namespace

ClosedHoles close_holes(Mesh& mesh) {
  ClosedHoles result;
  for (std::vector<int>& cycle : boundary_cycles(boundary_edges(mesh))) {
    ++result.holes;
    result.edges += static_cast<std::int64_t>(cycle.size());
    std::reverse(cycle.begin(), cycle.end());  // the lid runs against the edges it closes
    std::vector<Triangle> lid;
    if (cycle.size() == 3) {
      lid = {{cycle[0], cycle[1], cycle[2]}};
    } else if (cycle.size() <= kLongestSearch) {
      lid = lid_of_least_area(mesh, cycle);
    }
    if (lid.empty()) lid = fan(mesh, cycle);
    for (const Triangle& triangle : lid) {
      result.area += triangle_area(mesh, triangle);
      mesh.triangles.push_back(triangle);
    }
  }
  return result;
}

}  // namespace binderjet
