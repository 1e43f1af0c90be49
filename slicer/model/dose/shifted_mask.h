// SPDX-License-Identifier: GPL-3.0-or-later
// Where the pixels of a mask land when the printer shifts it, in whole numbers of 1/kFine voxels.
//
// An edge that lands 5/16 of a voxel beyond voxel a counts 11/16 at a and 5/16 at a + 1, so the
// sums of the dose stay integers, 16 times as large for each axis.
#pragma once

#include <algorithm>
#include <cmath>

#include "slicer/layers/grid.h"
#include "slicer/model/dose/bed_dependence.h"

namespace binderjet {

constexpr int kFine = 16;

// A length as whole voxels and 0 <= part < kFine more.
struct FineLength {
  int whole;
  int part;
};
inline FineLength split_fine(int fine) {
  const int whole = fine / kFine - (fine % kFine < 0 ? 1 : 0);
  return {whole, fine - whole * kFine};
}

// The mask of one layer of a job.
class ShiftedMask {
 public:
  ShiftedMask(const Grid& grid, const JobPlace& place, const BedDependence& placed, int width_px,
              int layer)
      : grid_(grid), place_(place), placed_(placed), width_px_(width_px), layer_(layer) {}

  struct Row {
    Spot middle;
    int shift;  // along y
  };
  Row row(int y_px) const {
    const int ry = grid_.detail_vx[1];
    const Spot middle = spot_at(grid_, place_, grid_.detail_vx[0] * width_px_ / 2.0,
                                (y_px + 0.5) * ry - 0.5, layer_);
    return {middle, fine(placed_.shift_at(middle)[1] / grid_.voxel_mm(1))};
  }
  // Where the lower side of pixel x of this row lands along x, from that of the mask.
  int edge(const Row& row, int x_px) const {
    Spot spot = row.middle;
    spot.x_mm = place_.origin_mm[0] + x_px * grid_.pitch_mm[0];
    return fine(x_px * grid_.detail_vx[0] + placed_.shift_at(spot)[0] / grid_.voxel_mm(0));
  }

 private:
  static int fine(double vx) { return static_cast<int>(std::lround(vx * kFine)); }

  const Grid& grid_;
  const JobPlace& place_;
  const BedDependence& placed_;
  int width_px_;
  int layer_;
};

}  // namespace binderjet
