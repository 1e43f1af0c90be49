// SPDX-License-Identifier: GPL-3.0-or-later
// Connected regions of a volume that passes by slice after slice; only the last slice is kept.
//
// Each run of the new slice begins as a region of its own and is joined (union-find) with the runs
// that it overlaps in the row before and in the same row of the slice below:
//
//   slice n + 1   .##...##.      two runs, joined through the slice below
//   slice n       .########      one region
//
// A region that the new slice does not continue is complete: it is handed out and forgotten, so
// memory follows the widest slice and not the height.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "slicer/layers/run_layer.h"

namespace binderjet {

// A region of voxels that touch by faces, in three dimensions.
struct Region {
  std::array<int, 3> low{};   // the least x, y and slice
  std::array<int, 3> high{};  // the greatest, plus 1
  std::int64_t voxels = 0;
  bool touches = false;  // holds a voxel that was marked
  double widest = 0;     // the largest of the widths that came with its runs

  // Takes in another region, or a first one if this has no voxel yet.
  void include(const Region& other);
};

// A region whose z counts layers, in slices.
Region in_slices(Region region, int slices_per_layer);

class RegionFinder {
 public:
  explicit RegionFinder(int first_slice = 0) : slice_(first_slice) {}

  // Adds the next slice up and returns the regions that end below it. `marks` may be null; `widths`
  // is empty or has one number for each run of the slice, row by row.
  std::vector<Region> add(const RunLayer& slice, const RunLayer* marks = nullptr,
                          std::span<const double> widths = {});
  // The regions that reach to the end.
  std::vector<Region> finish();

 private:
  std::size_t root(std::size_t node);
  void join(std::size_t a, std::size_t b);

  int slice_;
  RunLayer last_;                    // the slice added last
  std::vector<std::size_t> of_run_;  // its runs' regions
  std::vector<Region> regions_;      // those that it holds, then its successor's runs
  std::vector<std::size_t> parent_;  // of each entry of regions_; itself at the root
};

}  // namespace binderjet
