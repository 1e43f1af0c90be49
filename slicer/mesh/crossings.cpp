// SPDX-License-Identifier: GPL-3.0-or-later
// CGAL's box sweep finds the candidates, its exact predicates decide.
#include "slicer/mesh/crossings.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/box_intersection_d.h>
#include <CGAL/intersections.h>

#include <algorithm>
#include <vector>

namespace binderjet {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using SweepBox = CGAL::Box_intersection_d::Box_with_info_d<double, 3, int>;

}  // namespace

std::int64_t count_crossings(const Mesh& mesh) {
  const auto corner = [&](int triangle, std::size_t c) {
    const int point = mesh.triangles[static_cast<std::size_t>(triangle)][c];
    const Point& p = mesh.points[static_cast<std::size_t>(point)];
    return Kernel::Point_3(p[0], p[1], p[2]);
  };
  const auto shape = [&](int t) {
    return Kernel::Triangle_3(corner(t, 0), corner(t, 1), corner(t, 2));
  };
  std::vector<SweepBox> boxes;
  boxes.reserve(mesh.triangles.size());
  for (int t = 0; t < static_cast<int>(mesh.triangles.size()); ++t) {
    // Triangles without area lie on their neighbors by nature.
    if (!shape(t).is_degenerate()) boxes.emplace_back(shape(t).bbox(), t);
  }
  std::int64_t count = 0;
  CGAL::box_self_intersection_d(
      boxes.begin(), boxes.end(), [&](const SweepBox& a, const SweepBox& b) {
        const Triangle& first = mesh.triangles[static_cast<std::size_t>(a.info())];
        const Triangle& second = mesh.triangles[static_cast<std::size_t>(b.info())];
        for (const int point : first) {
          if (std::find(second.begin(), second.end(), point) != second.end()) return;
        }
        count += CGAL::do_intersect(shape(a.info()), shape(b.info())) ? 1 : 0;
      });
  return count;
}

}  // namespace binderjet
