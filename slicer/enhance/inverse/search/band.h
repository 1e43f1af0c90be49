// SPDX-License-Identifier: GPL-3.0-or-later
// The voxels that a search looks at, numbered without a gap: rows of runs near the boundary, where
// a plane of the whole layer would hold a hundred times as many.
//
//   open pixels      . . # # . . # .        what may flip
//   their voxels     ..############..       grown by what a pixel reaches; runs that meet are one
//
// Values of voxels (dose, price) lie in arrays of size(); a row of a stamp that begins in a run
// stays in it, so a loop over the stamp's row is a loop over neighbors in the array.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "slicer/enhance/rules/rect_cells.h"
#include "slicer/layers/run_layer.h"

namespace binderjet {

// Voxels [x0, x1) of a row, the first of them number `first`.
struct BandRun {
  int x0;
  int x1;
  std::size_t first;
};

class Band {
 public:
  // `reach` is what pixel (0, 0) reaches, in voxels; `repeat` the voxels of a pixel in x and y.
  Band(const RunLayer& open, const Rect& reach, std::array<int, 2> repeat);

  std::size_t size() const { return size_; }
  int first_row() const { return first_row_; }
  int last_row() const { return first_row_ + static_cast<int>(row_ends_.size()); }  // not included
  // In order of x; none outside the rows.
  std::span<const BandRun> row(int y) const;
  // The number of voxel (x, y), which must be in the band.
  std::size_t number(int x, int y) const;

 private:
  int first_row_ = 0;
  std::vector<std::size_t> row_ends_;
  std::vector<BandRun> runs_;
  std::size_t size_ = 0;
};

}  // namespace binderjet
