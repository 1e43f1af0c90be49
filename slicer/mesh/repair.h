// SPDX-License-Identifier: GPL-3.0-or-later
// A mesh made printable, as little as possible, and a list of what that took.
#pragma once

#include <string>
#include <vector>

#include "slicer/base/work.h"
#include "slicer/mesh/mesh.h"

namespace binderjet {

struct Repair {
  std::vector<std::string> notes;    // what was changed, with counts
  std::vector<std::string> remarks;  // what is unusual but was left alone
};

// Voxels are inside where the surface winds around them, so a surface is printable once no
// directed edge is left without its opposite. One that is stays as it is, however it crosses
// itself: its coordinates are not touched, and it loses only faces that name a point twice. Others
// are merged, oriented, stitched and closed, each only if it helps; what was inside out is turned.
//
// Throws Error (kBadInput, at `where`) for what cannot be printed honestly: no volume, or a
// surface whose lids would be over half as large as what is there. With `wall` > 0, in the mesh's
// units, the latter gets a wall of this thickness instead.
// `work` is asked between the steps whether to go on.
Repair repair_mesh(Mesh& mesh, const std::string& where, double wall = 0, const Work& work = {});

}  // namespace binderjet
