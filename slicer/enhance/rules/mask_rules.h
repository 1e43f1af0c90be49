// SPDX-License-Identifier: GPL-3.0-or-later
// What a mask may look like: no island of binder and no hole in it with fewer pixels than the
// printer's minimum, the profile's [mask]. Pixels hang together by their sides; beyond the job's
// box all is powder.
//
//   . . . . . . . .    with a minimum of 4 pixels for both:
//   . # # # # . # .    the hole of two is filled, then the island of three is erased;
//   . # . . # . # #    holes come first, for what fills a hole belongs to the island around it
//   . # # # # . . .
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "slicer/enhance/rules/rect_cells.h"
#include "slicer/layers/run_layer.h"

namespace binderjet {

// A profile's [mask]: how many pixels, that meet at their sides, an island of binder and a hole in
// it must have at least. 1 asks for nothing.
struct MaskRules {
  int min_island_px = 1;
  int min_hole_px = 1;

  // The larger of both: how far around a pixel one has to look.
  int largest_px() const { return std::max(min_island_px, min_hole_px); }
};

// How many islands and holes were too small.
struct RuleChanges {
  std::int64_t islands_erased = 0;
  std::int64_t holes_filled = 0;

  bool any() const { return islands_erased + holes_filled > 0; }
  bool operator==(const RuleChanges&) const = default;
};

// A whole mask as the rules leave it. On runs: the cost is the boundary's.
struct ObeyingMask {
  RunLayer mask;
  RuleChanges changes;
};
ObeyingMask obeying_mask(const RunLayer& mask, const MaskRules& rules);

// Asks for the rules around single pixels. Pixels at the edge of the plane hang together with all
// beyond it, so a plane needs largest_px() pixels around what is asked for.
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

// The same within an area of pixels: holes that are too small are filled, then islands that are too
// small are erased, so that it obeys for good.
void obey(const MaskRules& rules, const Rect& area, Plane<std::uint8_t>& mask);

}  // namespace binderjet
