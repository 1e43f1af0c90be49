// SPDX-License-Identifier: GPL-3.0-or-later
// Wavefront MTL: the diffuse color and image of each named material.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "slicer/mesh/paint.h"

namespace binderjet {

struct Material {
  std::optional<Rgb> color;
  std::string image;  // as the file names it; empty without
};

// Reads the library at `path` into `materials`. An image's name is the rest of its line behind the
// options, for names hold spaces.
void read_materials(const std::string& path, std::map<std::string, Material>& materials);

}  // namespace binderjet
