// SPDX-License-Identifier: GPL-3.0-or-later
// The printer grid, the finer voxel grid and the box of a job (slicer/MODEL.md, Grids). A
// part's size and an effect's widths become pixels and voxels here, so that they are rounded in one
// way.
#pragma once

#include <array>

namespace binderjet {

// Printer pixel (i, j) of layer k covers [i, i+1) x [j, j+1) x [k, k+1) times pitch_mm. Each pixel
// is cut into detail_vx voxels (rx, ry, rz); slice n = k rz + s is one voxel high.
struct Grid {
  std::array<double, 3> pitch_mm{};
  std::array<int, 3> detail_vx{2, 2, 2};

  double voxel_mm(int axis) const { return pitch_mm[axis] / detail_vx[axis]; }
  // Where voxel `index` has its center.
  double center_mm(int axis, int index) const { return (index + 0.5) * voxel_mm(axis); }
};

// A job's box: the part's box grown by the printer model's reach, in whole pixels.
struct JobBox {
  std::array<int, 3> size_px{};    // nx, ny, layers
  std::array<int, 3> margin_px{};  // from the box's lower corner to the part's
  std::array<int, 3> bed_px{};     // the box's lower corner on the bed; negative off the bed

  int width_vx(const Grid& grid) const { return size_px[0] * grid.detail_vx[0]; }
  int height_vx(const Grid& grid) const { return size_px[1] * grid.detail_vx[1]; }
};

// Where a job's masks are on the bed, for effects that depend on the place.
struct JobPlace {
  std::array<double, 2> origin_mm{};  // the lower corner of the masks
  std::array<double, 2> size_mm{};    // of the masks

  double center_mm(std::size_t axis) const { return origin_mm[axis] + size_mm[axis] / 2; }
};
JobPlace place_of(const JobBox& box, const Grid& grid);

// Pixels or layers needed for a length from 0; a length within rounding of a whole number is that
// number, so that 10.2 mm are 100 layers of 0.102 mm.
int pixels_for(double length_mm, double pitch_mm);

// The box of a part of this size whose lower corner is on bed pixel `corner_px`.
JobBox job_box(const std::array<double, 3>& part_mm, const Grid& grid, std::array<int, 2> corner_px,
               std::array<int, 2> reach_vx);

}  // namespace binderjet
