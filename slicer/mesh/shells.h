// SPDX-License-Identifier: GPL-3.0-or-later
// The pieces of a surface, and which way round they are.
#pragma once

#include <vector>

#include "slicer/mesh/mesh.h"

namespace binderjet {

struct Shells {
  std::vector<int> of_triangle;  // the shell of each triangle, from 0
  int count = 0;
};

// Pieces that hang together by points.
Shells shells_by_points(const Mesh& mesh);

// Pieces that hang together by edges of exactly two triangles.
Shells shells_by_edges(const Mesh& mesh);

// Turns triangles until, within each piece that hangs together by edges of two triangles,
// neighbors agree; the smaller area of a piece turns, so what was right stays. (CGAL's
// orient_polygon_soup follows the piece's first face and doubles points where it cannot.) Returns
// how many turned.
int orient_triangles(Mesh& mesh);

// Turns closed pieces inside in -> out unless they are cavities, that is inside another piece.
// Returns how many turned.
int turn_shells_outward(Mesh& mesh);

}  // namespace binderjet
