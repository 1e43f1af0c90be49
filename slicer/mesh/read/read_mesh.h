// SPDX-License-Identifier: GPL-3.0-or-later
// A model file of any known format, read as one triangle mesh in the file's own numbers.
#pragma once

#include <string>
#include <vector>

#include "slicer/mesh/mesh.h"
#include "slicer/mesh/paint.h"

namespace binderjet {

struct MeshFile {
  Mesh mesh;                          // coordinates as in the file; every index valid, all finite
  double unit_mm = 1.0;               // what one unit of the file is in millimeters
  bool unit_declared = false;         // false: the format carries no unit, 1 mm is a guess
  Paint paint;                        // its color, in the same coordinates; empty without
  std::vector<std::string> warnings;  // what was odd but did not stop the reading
};

// The largest coordinate, in millimeters, that is taken for a real part: a thousand kilometers.
inline constexpr double kMaxCoordinateMm = 1e9;

// STL (binary and text), PLY, OBJ, OFF, 3MF, VRML, glTF/GLB and what assimp knows besides; the
// content decides where it is unmistakable, else the extension. Polygons are cut into fans: the
// signed areas of a fan add up to the polygon even where it is concave, so the winding number is
// right. Throws Error (kBadInput) naming file, line or face.
MeshFile read_mesh(const std::string& path);

}  // namespace binderjet
