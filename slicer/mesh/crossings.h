// SPDX-License-Identifier: GPL-3.0-or-later
// Where a surface goes through itself.
#pragma once

#include <cstdint>

#include "slicer/mesh/mesh.h"

namespace binderjet {

// The pairs of triangles without a common point that meet. Exact; about a second for a million
// triangles.
std::int64_t count_crossings(const Mesh& mesh);

}  // namespace binderjet
