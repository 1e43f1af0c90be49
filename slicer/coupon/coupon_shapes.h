// SPDX-License-Identifier: GPL-3.0-or-later
// Boxes, prisms and balls, from which coupons are put together. Shapes may touch or overlap where
// united() (united.h) makes one surface of them.
#pragma once

#include <array>

#include "slicer/mesh/mesh.h"

namespace binderjet {

// Millimeters; `low` is below `high` on every axis.
void add_box(Mesh& mesh, const Point& low, const Point& high);

// A box between two corners, with x and y exchanged where `along_y`.
void add_turned(Mesh& mesh, Point low, Point high, bool along_y);

// A triangle moved along `way`, which is not in its plane.
void add_prism(Mesh& mesh, const std::array<Point, 3>& base, const Point& way);

// Cuts each triangle of a ball of radius 1 in four and lifts the new points onto it.
void split_unit_ball(Mesh& mesh);

Mesh full_coupon();

}  // namespace binderjet
