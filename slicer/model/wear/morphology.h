// SPDX-License-Identifier: GPL-3.0-or-later
// Erosion and dilation of a stack of layers by an ellipsoid, on runs, a layer at a time.
//
// A row of the result is made of the rows that the ellipsoid reaches. At offset (dy, dz) the
// ellipsoid is 2 h + 1 voxels wide, so there each run grows by h at both ends (dilation: the union
// of these rows) or shrinks by h (erosion: their intersection):
//
//   dy =  1    .#.    h = 0: run [3, 7) of that row counts as [3, 7)
//   dy =  0    ###    h = 1: as [2, 8) in a dilation, as [4, 6) in an erosion
//   dy = -1    .#.    h = 0
//
// Cost: the rows of the ellipsoid times the flips of the layer.
#pragma once

#include <array>

#include "slicer/layers/grid.h"
#include "slicer/layers/run_layer.h"
#include "slicer/layers/window.h"

namespace binderjet {

// All offsets (voxels in x and y, layers in z) within `radius_mm` of the middle.
class Ellipsoid {
 public:
  Ellipsoid(double radius_mm, const Grid& grid);
  // The same within its layer only.
  static Ellipsoid disc(double radius_mm, const Grid& grid);

  // How far it reaches: voxels in x and y, layers in z.
  std::array<int, 3> reach() const { return reach_; }
  // Half its width along x at this offset; negative if there is nothing of it.
  int half_width(int dy, int dz) const;

 private:
  std::array<double, 3> radius_;
  std::array<int, 3> reach_;
};

// `window` holds reach()[2] layers on each side of the middle one; null is beyond the stack. Within
// a layer all outside is powder.
RunLayer dilated(const RunWindow& window, const Ellipsoid& by);

// The voxels of `within`, a layer of the same size, that are dilated. A row of it ends once all its
// voxels are, which most rows of a solid are at once.
RunLayer dilated_within(const RunWindow& window, const Ellipsoid& by, const RunLayer& within);

// What lies beyond the stack in z: powder, or more of the same.
enum class Beyond { kPowder, kSame };
RunLayer eroded(const RunWindow& window, const Ellipsoid& by, Beyond beyond);

}  // namespace binderjet
