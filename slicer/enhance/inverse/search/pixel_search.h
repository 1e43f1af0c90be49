// SPDX-License-Identifier: GPL-3.0-or-later
// Direct binary search: single pixels of a mask are flipped, or change places with one beside them,
// as long as that makes the print better and the mask keeps to the rules.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "slicer/enhance/inverse/search/local_dose.h"
#include "slicer/enhance/rules/mask_rules.h"
#include "slicer/enhance/rules/rect_cells.h"

namespace binderjet {

using Pixel = std::array<int, 2>;

class PixelSearch {
 public:
  // `dose` is that of `mask`. Only `pixels`, within the dose's tile, are flipped.
  PixelSearch(LocalDose& dose, Plane<std::uint8_t>& mask, std::span<const Pixel> pixels,
              const MaskRules& rules);

  // Visits the pixels in their order, again and again, until none helps any more: each step lowers
  // the weighted count of wrong voxels, so it ends. `max_sweeps` bounds the time.
  void run(int max_sweeps);

 private:
  int sign(const Pixel& p) const { return *mask_.at(p[0], p[1]) != 0 ? -1 : 1; }
  bool improve(const Pixel& p, bool with_swaps);
  bool improve_by_swap(const Pixel& p, int own_cost);
  bool take(const Pixel& p);
  void flip(const Pixel& p);
  void look_again_around(const Pixel& p);

  LocalDose& dose_;
  Plane<std::uint8_t>& mask_;
  std::span<const Pixel> pixels_;
  RuleCheck rules_;
  Plane<std::uint8_t> waiting_;  // pixels to look at: something near has changed
  Plane<std::uint8_t> free_;     // those of pixels_
};

}  // namespace binderjet
