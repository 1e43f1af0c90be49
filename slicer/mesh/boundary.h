// SPDX-License-Identifier: GPL-3.0-or-later
// The boundary of an oriented surface: the directed edges that no other face cancels.
//
// The winding number of a surface is the same along every path exactly when this boundary is
// empty, whatever else is odd about the surface: it may cross itself, touch itself along edges, or
// consist of many shells. So this, and not manifoldness, is what a printable surface must fulfill.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "slicer/mesh/mesh.h"

namespace binderjet {

using DirectedEdge = std::array<int, 2>;  // from, to: points of the mesh

// Each edge as often as it is left over, in order of its smaller point. At every point as many of
// them begin as end.
std::vector<DirectedEdge> boundary_edges(const Mesh& mesh);

struct EdgeCounts {
  std::int64_t open = 0;     // directed edges of the boundary
  std::int64_t crowded = 0;  // edges of more than two faces
};

// Takes about 14 bytes a triangle beside the mesh.
EdgeCounts count_edges(const Mesh& mesh);

inline bool is_closed(const Mesh& mesh) { return count_edges(mesh).open == 0; }

// The volume inside, counted as often as the surface winds around it; negative if inside out.
double signed_volume(const Mesh& mesh);

double triangle_area(const Mesh& mesh, const Triangle& triangle);
double surface_area(const Mesh& mesh);

}  // namespace binderjet
