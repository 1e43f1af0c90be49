// SPDX-License-Identifier: GPL-3.0-or-later
// What a mask may look like: no island of binder and no hole in it with fewer pixels than the
// profile's minimum. Pixels hang together by their sides; beyond the job's box all is powder.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "slicer/enhance/rules/rect_cells.h"

namespace binderjet {

struct MaskRules {
  int min_island_px = 1;
  int min_hole_px = 1;

  int most() const { return std::max(min_island_px, min_hole_px); }
};

// Asks for the rules around single pixels. Pixels at the edge of the plane hang together with all
// beyond it, so a plane needs most() pixels around what is asked for.
class RuleCheck {
 public:
  explicit RuleCheck(const MaskRules& rules) : rules_(rules) {}

  // The island or hole that holds this pixel and the four beside it are large enough.
  bool fits_around(const Plane<std::uint8_t>& mask, int x, int y);
  // Flips the island or hole that holds this pixel if it is too small.
  void repair(Plane<std::uint8_t>& mask, int x, int y);

 private:
  bool fits(const Plane<std::uint8_t>& mask, int x, int y);

  MaskRules rules_;
  std::vector<std::array<int, 2>> found_;
};

// Makes the mask obey within `area`: holes that are too small are filled, then islands that are too
// small are erased, so that it obeys for good.
void obey(const MaskRules& rules, const Rect& area, Plane<std::uint8_t>& mask);

}  // namespace binderjet
