// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/layers/grid.h"

#include <algorithm>
#include <cmath>

namespace binderjet {

int pixels_for(double length_mm, double pitch_mm) {
  constexpr double kRounding = 1e-9;
  return std::max(1, static_cast<int>(std::ceil(length_mm / pitch_mm - kRounding)));
}

JobBox job_box(const std::array<double, 3>& part_mm, const Grid& grid, std::array<int, 2> corner_px,
               std::array<int, 2> reach_vx) {
  JobBox box;
  for (int axis = 0; axis < 3; ++axis) {
    const int part_px = pixels_for(part_mm[axis], grid.pitch_mm[axis]);
    if (axis < 2) {
      const int detail = grid.detail_vx[axis];
      box.margin_px[axis] = (reach_vx[axis] + detail - 1) / detail;
      box.bed_px[axis] = corner_px[axis] - box.margin_px[axis];
    }
    box.size_px[axis] = part_px + 2 * box.margin_px[axis];
  }
  return box;
}

JobPlace place_of(const JobBox& box, const Grid& grid) {
  JobPlace place;
  for (std::size_t axis = 0; axis < 2; ++axis) {
    place.origin_mm[axis] = box.bed_px[axis] * grid.pitch_mm[axis];
    place.size_mm[axis] = box.size_px[axis] * grid.pitch_mm[axis];
  }
  return place;
}

}  // namespace binderjet
