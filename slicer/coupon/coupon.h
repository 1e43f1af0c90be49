// SPDX-License-Identifier: GPL-3.0-or-later
// Test parts that the program makes itself: what a printer loses, in one piece.
#pragma once

#include <string>
#include <vector>

#include "slicer/mesh/mesh.h"

namespace binderjet {

// The words that coupon() knows.
const std::vector<std::string>& coupon_kinds();

// A closed, oriented part in millimetres; `kind` is one of coupon_kinds().
// clang-format off
//   slots     the paper's block (Fig. 3): slots of 0.1 to 1.0 mm across x, and again across y;
//             turned up (--rotate) it is the third, across z
//   walls     a plate with free-standing walls of 0.1 to 1.5 mm along x and along y
//   full      30 x 30 x 4.4 mm on which effects look different: see coupon_full.cpp
//   golfball  a dimpled ball of 42.7 mm (Fig. 10)
// clang-format on
Mesh coupon(const std::string& kind);

// Binary STL, written whole or not at all.
void write_stl(const Mesh& mesh, const std::string& path);

}  // namespace binderjet
