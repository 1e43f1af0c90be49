// SPDX-License-Identifier: GPL-3.0-or-later
// One reader per family of formats; read_mesh() chooses, and checks what comes back.
//
// STL, OBJ, PLY and OFF have readers of our own: CGAL's allocate whatever a header claims (a list
// of 2^31 corners, 353,535,235,358 points), answer only yes or no where an error has to name its
// line, refuse OBJ files with lines in them, and keep a std::map of points for STL. The formats
// are small; the libraries do the large ones.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "slicer/base/counted.h"
#include "slicer/mesh/read/input_file.h"
#include "slicer/mesh/read/read_mesh.h"

namespace binderjet {

MeshFile read_stl(InputFile& file);
// `path` is where the model lies, for the materials and images beside it.
MeshFile read_obj(InputFile& file, const std::string& path);
MeshFile read_ply(InputFile& file, const std::string& path);
MeshFile read_off(InputFile& file);
MeshFile read_3mf(const std::string& path, const std::string& name);
MeshFile read_wrl(InputFile& file, const std::string& path);
MeshFile read_with_assimp(const std::string& path, const std::string& name);

// Appends a polygon as a fan of triangles. Indices are not checked here.
void add_polygon(Mesh& mesh, std::span<const int> corners);

// Throws unless `count` things of at least `bytes` bytes each can be in the file, which is asked
// before anything is allocated, and int can index them.
void check_claim(const InputFile& file, const std::string& where, std::int64_t count,
                 std::int64_t bytes, const std::string& things);

}  // namespace binderjet
