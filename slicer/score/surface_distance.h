// SPDX-License-Identifier: GPL-3.0-or-later
// How far voxels are from the target's surface, exactly: the distance in mm from a voxel's center
// to the nearest point of a voxel of the other state. With h the sides of a voxel, and d = (dx, dy,
// dz) voxels from the one to the other,
//
//   distance^2 = min over d of  gap(dx)^2 + gap(dy)^2 + gap(dz)^2,   gap(n) = max(0, |n| - 1/2) h
//
//   target   ######....      gap, in h, for the target's voxels:  ..., 2.5, 1.5, 0.5 at the edge
//
// The minimum is taken along one axis after the other (Meijster et al., A general algorithm for
// computing distance transforms in linear time, 2000): along z for a whole row, which is a few
// runs; of these rows along y; of that along x. With n rows or slices within max_mm, a row so costs
// 2 n of them and not n^2, also in the middle of a solid. The search begins close by and goes on
// only with what it has not found there: most wrong voxels lie in a thin skin.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "slicer/layers/grid.h"
#include "slicer/layers/run_layer.h"

namespace binderjet {

// Of the voxels of one slice.
class SurfaceDistance {
 public:
  // No voxel within `max_mm` lies more slices away.
  static int reach_slices(const Grid& grid, double max_mm);

  // Farther than `max_mm` is not searched. `slices` are 2 reach_slices() + 1 slices of the target,
  // from the lowest, which must outlive this; null ones are powder, and so is what lies beyond a
  // slice's box. The middle one must be there.
  SurfaceDistance(const Grid& grid, double max_mm, std::span<const RunLayer* const> slices);

  // The voxels [first, last) of row y of the middle slice are all solid, or all powder. Writes the
  // distance of each, max_mm where nothing is found.
  void of_run(int y, int first, int last, bool solid, std::vector<double>& distances_mm);

 private:
  // Voxels [first, last) of a row of the middle slice, and how far straight above or below them the
  // nearest voxel of the other state is.
  struct Stretch {
    int first;
    int last;
    double gap2_mm2;  // gap(dz)^2
  };
  using Stretches = std::vector<Stretch>;

  // Of the voxels [first, last) of row y those that have one within `radius_mm`, in order of x.
  Stretches along_z(int y, int first, int last, bool solid, double radius_mm) const;
  // The same of all voxels of the row and of those near its ends, within max_mm; kept.
  const Stretches& whole_row(int y, bool solid);
  // Squared distances; max_mm squared where the surface is not within `radius_mm`.
  void search(int y, int first, int last, bool solid, double radius_mm, double* squares);

  double max_mm_;
  std::array<double, 3> voxel_mm_;
  std::span<const RunLayer* const> slices_;
  std::array<std::vector<std::optional<Stretches>>, 2> rows_;  // by state, from y = -reach on
};

}  // namespace binderjet
