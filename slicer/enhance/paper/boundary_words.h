// SPDX-License-Identifier: GPL-3.0-or-later
// Tiles of bits around the boundary, one 64-bit word a row: where the rule works, and nowhere else.
//
//   word       | 1 | 62 columns that the rule may change | 1 |      and 32 rows, 1 above, 1 below
//   neighbors    ^                                         ^         are drawn, not changed
//
// Only tiles that hold boundary voxels are drawn, so the cost is the boundary's. The outer columns
// and rows let every voxel of a tile see its neighbors without a look into the next tile.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "slicer/layers/run_layer.h"

namespace binderjet {

constexpr int kTileColumns = 62;
constexpr int kTileRows = 32;
constexpr int kDrawnRows = kTileRows + 2;

// The slices of a layer and one slice below and above: [0] is below, [rz + 1] above; null is
// powder.
using Slab = std::vector<const RunLayer*>;

// Finds the tiles that hold the boundary voxels of a band of kTileRows rows.
class ActiveTiles {
 public:
  explicit ActiveTiles(int width);

  // The first columns of the tiles, ascending; the columns of two tiles do not meet. `y` is the
  // band's first row.
  const std::vector<int>& find(const Slab& volume, int y);

 private:
  void widen(std::span<const int> row);
  void flush();
  void mark_difference(std::span<const int> a, std::span<const int> b);
  void mark(int first, int last);
  void place_tiles();

  int width_;
  std::vector<std::uint64_t> granules_;  // a bit for every kGranule columns with boundary voxels
  std::vector<int> tiles_;
  std::vector<int> low_;  // per rank, over the rows of the same number of flips
  std::vector<int> high_;
};

// One layer's bits under the tiles of a band; each tile's words begin one column left of it.
class DrawnBand {
 public:
  using Words = std::array<std::uint64_t, kDrawnRows>;
  const Words& operator[](std::size_t tile) const { return words_[tile]; }

  // Rows y to y + kDrawnRows - 1; outside the layer, and for no layer, all is powder.
  void draw(const RunLayer* layer, const std::vector<int>& tiles, int y);

 private:
  void draw_row(std::span<const int> row, const std::vector<int>& tiles, std::size_t r);

  std::vector<Words> words_;
};

}  // namespace binderjet
