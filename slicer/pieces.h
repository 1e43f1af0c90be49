// SPDX-License-Identifier: GPL-3.0-or-later
// Parts that come out of the powder in several pieces, counted while the layers pass by.
#pragma once

#include <cstdint>
#include <set>
#include <vector>

#include "slicer/run_layer.h"
#include "slicer/voxelize.h"

namespace binderjet {

// Numbers the regions of a volume, voxels that touch by faces, slice after slice. A region keeps
// its number; two that meet become one with two numbers.
class RegionNumbers {
 public:
  // The numbers of the next slice's runs, row by row.
  const std::vector<int>& add(const RunLayer& slice);
  // One number for all numbers of a region.
  int root(int number);

 private:
  void take(int& own, int other);

  RunLayer last_;  // the slice added last
  std::vector<int> of_run_;
  std::vector<int> parent_;  // by number; itself at the root
};

class PieceCounter {
 public:
  // The next layer up; the slices of the target print as one.
  void add(const VoxelLayer& target, const RunLayer& printed);
  // Connected regions of the target that more than one connected region of the print has voxels
  // of.
  std::int64_t separated();

 private:
  RegionNumbers parts_;
  RegionNumbers pieces_;
  std::vector<std::set<int>> pieces_of_;  // by a part's number
};

}  // namespace binderjet
