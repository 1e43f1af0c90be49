// SPDX-License-Identifier: GPL-3.0-or-later
// What one pixel of a mask adds to the dose, in whole units: the kernels of all terms from its
// layer, summed over the voxels of the pixel.
//
//   dose of a layer = sum over the pixels that are on of the pixel's stamp, laid where it lands
//
// A row of pixels is the difference of two half-lines, and so is a pixel:
//
//   half_line(a)      ./########       the kernel's running sum, from pixel a on without an end
//   - half_line(b)    ........./###    the same from pixel b on
//   pixels a to b-1   ./######/\...    (the last columns fall)
//
// So the stamps of a row add up to the row exactly, however they are rounded.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <span>
#include <vector>

#include "slicer/enhance/rules/rect_cells.h"
#include "slicer/layers/grid.h"
#include "slicer/model/dose/dose_filter.h"
#include "slicer/model/dose/shifted_mask.h"

namespace binderjet {

constexpr int kStampVector = 8;  // columns that are worked on at once

// Row-major.
struct Stamp {
  std::array<int, 2>
      first{};  // its lower corner from the voxel that the pixel's lower corner is in
  int width = 0;
  int height = 0;
  std::vector<std::int16_t> dose;
};

// How a pixel lies on the voxels, beyond whole ones, in 1/kFine voxels: its lower sides along x and
// y, and its width. Pixels with the same fit have the same stamp.
struct PixelFit {
  int part_x = 0;
  int width = 0;
  int part_y = 0;
  auto operator<=>(const PixelFit&) const = default;
};

class Stamps {
 public:
  // Of the terms that concern this layer; `unit` is a dose of 1.
  Stamps(std::span<const DoseTerm> terms, int layer, const Grid& grid, int unit);

  // Whole vectors wide: the last columns may be 0.
  const Stamp& pixel(const PixelFit& fit);
  // Beyond the last column all columns are like the last.
  const Stamp& half_line(int part_x, int part_y);

 private:
  std::vector<DoseTerm> terms_;
  int unit_;
  int pixel_rows_;
  std::array<int, 2> first_{};  // of all kernels together
  std::array<int, 2> last_{};
  std::map<PixelFit, Stamp> pixels_;
  std::map<std::array<int, 2>, Stamp> lines_;
};

}  // namespace binderjet
