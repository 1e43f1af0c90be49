// SPDX-License-Identifier: GPL-3.0-or-later
// Closing a surface: every cycle of its boundary gets a lid.
#pragma once

#include <cstdint>

#include "slicer/mesh/mesh.h"

namespace binderjet {

struct ClosedHoles {
  std::int64_t holes = 0;
  std::int64_t edges = 0;
  double area = 0;  // of the lids, in the mesh's units
};

// Adds triangles until the boundary is empty. That always works: the boundary of an oriented
// surface consists of cycles, and a cycle is closed by a fan from its centroid where no better lid
// is found. Whether the result is honest is for the caller to judge by the area.
ClosedHoles close_holes(Mesh& mesh);

}  // namespace binderjet
