// SPDX-License-Identifier: GPL-3.0-or-later
// Stamps of pixels that land between voxels (slicer/model/dose/shifted_mask.h), each made when
// first asked for.
#pragma once

#include <array>
#include <map>
#include <vector>

#include "slicer/enhance/inverse/search/stamp.h"
#include "slicer/layers/grid.h"
#include "slicer/model/dose/shifted_mask.h"

namespace binderjet {

// How a pixel lies on the voxels, beyond whole ones, in 1/kFine voxels: its lower sides along x and
// y, and its width. Pixels with the same fit have the same stamp.
struct PixelFit {
  int part_x = 0;
  int width = 0;
  int part_y = 0;
  auto operator<=>(const PixelFit&) const = default;
};

class ShiftedStamps {
 public:
  // Of the terms of `model` that concern this layer.
  ShiftedStamps(const StampedModel& model, int layer, const Grid& grid);

  // Stamps count from the voxel that the pixel's lower corner lands in.
  const Stamp& pixel(const PixelFit& fit);
  // Of a row of pixels that begins there and never ends. The stamp holds the columns in which it
  // rises; beyond them all columns are like the last.
  const Stamp& half_line(int part_x, int part_y);

 private:
  std::vector<DoseTerm> terms_;
  int layer_;
  int unit_;
  int pixel_rows_;
  std::array<int, 2> first_{};  // of all kernels together
  std::array<int, 2> last_{};
  std::map<PixelFit, Stamp> pixels_;
  std::map<std::array<int, 2>, Stamp> lines_;
};

}  // namespace binderjet
