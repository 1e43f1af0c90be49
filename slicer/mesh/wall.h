// SPDX-License-Identifier: GPL-3.0-or-later
// A wall behind an open surface, as scans and relief maps are: a volume that shows their front.
#pragma once

#include "slicer/mesh/mesh.h"

namespace binderjet {

// Adds the surface once more, `thickness` behind it along the normals of its points, and joins the
// two along its boundary. The result is closed and winds around the wall; what was there stays
// where it is. Faces must be oriented alike; `thickness` > 0, in the mesh's units.
void add_wall(Mesh& mesh, double thickness);

}  // namespace binderjet
