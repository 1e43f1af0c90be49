// SPDX-License-Identifier: GPL-3.0-or-later
// CGAL's tree of boxes over triangles that stay where they are: it holds their numbers only.
#pragma once

#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/Simple_cartesian.h>

#include <array>
#include <vector>

#include "slicer/mesh/mesh.h"

namespace binderjet {

// The triangles of a mesh or of a paint; what it points to must outlive the tree.
struct TriangleView {
  const std::vector<Point>* points = nullptr;
  const std::vector<Triangle>* triangles = nullptr;

  std::array<Point, 3> corners(int triangle) const {
    const Triangle& t = (*triangles)[static_cast<std::size_t>(triangle)];
    return {(*points)[static_cast<std::size_t>(t[0])], (*points)[static_cast<std::size_t>(t[1])],
            (*points)[static_cast<std::size_t>(t[2])]};
  }
};

// What the tree holds, in the form that CGAL asks for.
class TrianglePrimitive {
 public:
  using Kernel = CGAL::Simple_cartesian<double>;
  using Id = int;
  using Point = Kernel::Point_3;
  using Datum = Kernel::Triangle_3;
  using Datum_reference = Kernel::Triangle_3;
  using Point_reference = Kernel::Point_3;
  using Shared_data = TriangleView;

  TrianglePrimitive() = default;
  explicit TrianglePrimitive(int id) : id_(id) {}
  TrianglePrimitive(const std::vector<int>::const_iterator& place, const TriangleView&)
      : id_(*place) {}
  static TriangleView construct_shared_data(const TriangleView& view) { return view; }

  Id id() const { return id_; }
  Datum datum(const TriangleView& view) const {
    const auto t = view.corners(id_);
    return {place(t[0]), place(t[1]), place(t[2])};
  }
  Point reference_point(const TriangleView& view) const { return place(view.corners(id_)[0]); }

 private:
  static Point place(const binderjet::Point& p) { return {p[0], p[1], p[2]}; }
  int id_ = 0;
};

using TriangleTree =
    CGAL::AABB_tree<CGAL::AABB_traits<TrianglePrimitive::Kernel, TrianglePrimitive>>;

}  // namespace binderjet
