// SPDX-License-Identifier: GPL-3.0-or-later
// A scan that comes as a mesh, cut into a slice stack like any other scan.
#pragma once

#include <string>

#include "slicer/base/work.h"

namespace binderjet {

// Writes the mesh as a stack of kind "measured" to `folder`, at 0.05 mm in x and y and at half of
// `layer_mm` in z, where the mesh itself lies. Error{kBadInput} if the mesh cannot be read or is
// empty.
void write_scan_stack(const std::string& mesh, double layer_mm, const std::string& folder,
                      const Work& work = {});

}  // namespace binderjet
