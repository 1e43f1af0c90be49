// SPDX-License-Identifier: GPL-3.0-or-later
// What a profile says about color, and the color field of a part from its paint.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "slicer/base/work.h"
#include "slicer/color/field.h"
#include "slicer/mesh/mesh.h"
#include "slicer/mesh/paint.h"

namespace binderjet {

// The profile's [color] table.
struct ColorSettings {
  double depth_mm = 0.6;         // how deep color goes: powder is translucent
  int neighbors = 4;             // samples that a voxel's color is mixed from (paper, 4.4)
  double crease_strength = 0.7;  // 1 makes the deepest crease black
  double crease_radius_mm = 2;   // how far around it a crease is looked for
};

// The field of a part's paint; none if it has no color, or is white all over.
std::shared_ptr<const ColorField> paint_field(Paint paint, const ColorSettings& settings,
                                              std::vector<std::string>& warnings);

// `base` darkened in creases, so that detail survives the scattering of light in the powder (the
// paper's reference 3, and its Fig. 12): ambient occlusion within the radius, and how far the
// surface turns away from its surroundings. Sampled on the mesh, in its coordinates.
std::shared_ptr<const ColorField> crease_field(std::shared_ptr<const ColorField> base,
                                               const Mesh& mesh, const ColorSettings& settings,
                                               const Work& work = {});

}  // namespace binderjet
