// SPDX-License-Identifier: GPL-3.0-or-later
// CGAL's corefinement with exact constructions. It looks at all of both surfaces, so shapes are
// united in pairs, and the pairs in pairs: the hundred of the full coupon take a second.
#include "slicer/coupon/united.h"

#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/corefinement.h>
#include <CGAL/Surface_mesh.h>

#include <array>
#include <cassert>
#include <cmath>
#include <utility>
#include <vector>

#include "slicer/mesh/shells.h"

namespace binderjet {
namespace {

using Kernel = CGAL::Exact_predicates_exact_constructions_kernel;
using Surface = CGAL::Surface_mesh<Kernel::Point_3>;

// Whole millionths: three points on a line in decimal fractions of a millimeter are on a line as
// whole numbers too, and in binary fractions they are not.
constexpr double kUnit = 1e6;

double whole(double value) { return std::round(value * kUnit); }

std::vector<Surface> surfaces_of(const Mesh& shapes) {
  const Shells shells = shells_by_points(shapes);
  std::vector<Surface> surfaces(static_cast<std::size_t>(shells.count));
  std::vector<Surface::Vertex_index> vertices(shapes.points.size());
  for (std::size_t t = 0; t < shapes.triangles.size(); ++t) {
    Surface& surface = surfaces[static_cast<std::size_t>(shells.of_triangle[t])];
    std::array<Surface::Vertex_index, 3> corners;
    for (std::size_t c = 0; c < 3; ++c) {
      const auto point = static_cast<std::size_t>(shapes.triangles[t][c]);
      if (!vertices[point].is_valid()) {
        const Point& p = shapes.points[point];
        vertices[point] =
            surface.add_vertex(Kernel::Point_3(whole(p[0]), whole(p[1]), whole(p[2])));
      }
      corners[c] = vertices[point];
    }
    surface.add_face(corners[0], corners[1], corners[2]);
  }
  return surfaces;
}

Mesh mesh_of(const Surface& surface) {
  Mesh mesh;
  std::vector<int> number(surface.num_vertices() + surface.number_of_removed_vertices());
  for (const Surface::Vertex_index vertex : surface.vertices()) {
    number[vertex] = static_cast<int>(mesh.points.size());
    const Kernel::Point_3& p = surface.point(vertex);
    mesh.points.push_back({CGAL::to_double(p.x()) / kUnit, CGAL::to_double(p.y()) / kUnit,
                           CGAL::to_double(p.z()) / kUnit});
  }
  for (const Surface::Face_index face : surface.faces()) {
    Triangle triangle{};
    std::size_t corner = 0;
    for (const Surface::Vertex_index vertex :
         surface.vertices_around_face(surface.halfedge(face))) {
      triangle[corner++] = number[vertex];
    }
    mesh.triangles.push_back(triangle);
  }
  return mesh;
}

}  // namespace

Mesh united(const Mesh& shapes) {
  std::vector<Surface> surfaces = surfaces_of(shapes);
  while (surfaces.size() > 1) {
    std::vector<Surface> pairs((surfaces.size() + 1) / 2);
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      if (2 * i + 1 == surfaces.size()) {
        pairs[i] = std::move(surfaces[2 * i]);
        continue;
      }
      [[maybe_unused]] const bool manifold =
          CGAL::Polygon_mesh_processing::corefine_and_compute_union(surfaces[2 * i],
                                                                    surfaces[2 * i + 1], pairs[i]);
      assert(manifold);
    }
    surfaces = std::move(pairs);
  }
  return mesh_of(surfaces.front());
}

}  // namespace binderjet
