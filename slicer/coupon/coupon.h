// SPDX-License-Identifier: GPL-3.0-or-later
// Test parts that the program makes itself: what a printer loses, in one piece.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "slicer/mesh/mesh.h"

namespace binderjet {

enum class CouponKind {
  kSlots,    // the paper's block (Fig. 3): slots of 0.1 to 1.0 mm across x, and again across y;
             // turned up (--rotate) it is the third, across z
  kWalls,    // a plate with free-standing walls of 0.1 to 1.5 mm along x and along y
  kFull,     // 30 x 30 x 4.4 mm on which effects look different: see coupon_full.cpp
  kGolfBall  // a dimpled ball of 42.7 mm (Fig. 10)
};
inline constexpr std::array kCouponKinds{CouponKind::kSlots, CouponKind::kWalls, CouponKind::kFull,
                                         CouponKind::kGolfBall};
const char* word(CouponKind kind);
// The words of all kinds, and the kind of one of them.
std::vector<std::string> coupon_kinds();
std::optional<CouponKind> coupon_kind(const std::string& word);

// A closed, oriented part in millimeters.
Mesh coupon(CouponKind kind);

// Binary STL, written whole or not at all.
void write_stl(const Mesh& mesh, const std::string& path);

}  // namespace binderjet
