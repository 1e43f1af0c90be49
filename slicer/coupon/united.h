// SPDX-License-Identifier: GPL-3.0-or-later
// Shapes that touch or overlap, as the one surface around all of them.
#pragma once

#include "slicer/mesh/mesh.h"

namespace binderjet {

// `shapes` are closed, look outward and share no points with each other (coupon_shapes.h). The
// result neither crosses nor touches itself and has no wall within the solid, so that every reader
// of meshes takes it without a remark. Coordinates are rounded to a millionth of their unit first:
// faces that are meant to be one lie in one plane.
Mesh united(const Mesh& shapes);

}  // namespace binderjet
