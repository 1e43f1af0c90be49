// SPDX-License-Identifier: GPL-3.0-or-later
// The search for one layer's mask: single pixels near the boundary are flipped as long as the cost
// falls, while the masks of the layers around it stay. What a dose costs hardens in three stages:
//
//               powder wanted                 solid wanted
//   hinge       max(0, d - (level - m))       max(0, (level + m) - d)       m = 0.08
//   ramp        clamp((d - level) / w + 1/2)  1 - that                      w = 0.06
//   count       d >= level                    d < level                     under all models
//
//   cost |  hinge \         ramp ---\       count ---+
//        |         \                 \               |
//        |          \___              \___           +---      solid wanted
//        +-----------------> dose
//
// each times the price of the voxel (slicer/enhance/inverse/search/prices.h), and a little for each
// side of a pixel that is an edge of the mask.
//
// A count does not see that a dose of 0.2 is on the way to 0.5, so its search stays where it
// starts. The hinge is convex and pulls far away as near; the ramp is the mean over a spread of
// levels; the count is what is asked for, of the printer as it is and as it may drift.
//
// Pixels are looked at in the order of rows, forward and backward, and again when a pixel near
// them has flipped. So what a place gets depends on its surroundings alone, not on where in the
// layer it lies.
//
// Then two pixels near each other flip at once where neither would alone: one that is set and one
// that is cleared move a corner of the mask, two of a kind an edge. That takes a tenth to a third
// off the errors of hard parts (combs, lattices, text), and some percent off the worst of the
// window.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "slicer/enhance/inverse/search/doses.h"
#include "slicer/enhance/inverse/search/inverse_layer.h"
#include "slicer/enhance/inverse/search/search_model.h"
#include "slicer/enhance/rules/mask_rules.h"
#include "slicer/enhance/rules/rect_cells.h"

namespace binderjet {

// What is wrong with the print of a layer and must go, whatever else it costs.
struct SearchFaults {
  int offset = 0;    // of the layer from the middle one
  RunLayer missing;  // voxels
  RunLayer surplus;
};

class MaskSearch {
 public:
  // Of the middle layer, beginning with its mask so far. Both must outlive this.
  MaskSearch(const SearchModel& by, const LayerWindow& layers);

  void run();
  // Raises the price of these faults and searches again around them.
  void run_again(std::span<const SearchFaults> faults);

  RunLayer mask() const;

 private:
  template <class Change>
  void run_stage(int edge_price, Change change);
  void run_stages();
  template <class Change>
  void look(const OpenPixel& pixel, int edge_price, Change& change);
  // Whether any pair was flipped.
  bool flip_pairs(int edge_price);
  bool flip_pair_at(const OpenPixel& pixel, int edge_price);
  // What all costs grow by when the pixel flips, as the last stage counts. None if the flip would
  // stand alone, or if the printer's own cost grows by so much more than `most` that nothing the
  // drifted models gain makes up for it.
  std::optional<int> count_change(const OpenPixel& pixel, int edge_price, int most) const;
  void flip(const OpenPixel& pixel);
  int edge_change(const OpenPixel& pixel) const;
  bool would_stand_alone(const OpenPixel& pixel) const;
  int row(const OpenPixel& pixel) const { return doses_.runs()[pixel.run].y; }
  std::uint8_t& state(const OpenPixel& pixel) { return *mask_.at(pixel.x, row(pixel)); }
  int sign(const OpenPixel& pixel) const { return *mask_.at(pixel.x, row(pixel)) != 0 ? -1 : 1; }
  std::size_t number(const OpenPixel& pixel) const;
  // Calls act(run, x0, x1) for the open pixels in a rectangle.
  template <class Act>
  void each_open_in(const Rect& pixels, Act act) const;
  Rect near(int x, int y) const;
  void look_again(const OpenPixel& pixel);
  void wait_around(const RunLayer& voxels);
  void seed(const RunLayer& voxels, std::uint8_t state);

  const SearchModel& by_;
  const RunLayer& start_;
  RunLayer open_;
  Doses doses_;
  RuleCheck rules_;
  Plane<std::uint8_t> mask_;
  std::array<int, 2> near_px_{};
  std::vector<std::uint8_t> waiting_;     // the pixels to look at: something near has changed
  std::vector<std::uint8_t> pair_waits_;  // the same for pairs
  std::vector<std::uint8_t> free_;        // those that may flip now
  std::int64_t flips_ = 0;
  bool seeded_ = false;
};

}  // namespace binderjet
