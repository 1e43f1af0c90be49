// SPDX-License-Identifier: GPL-3.0-or-later
// Where a print bridges the gap between two regions of its target, along x, y and z.
#pragma once

#include <array>
#include <functional>
#include <map>
#include <span>
#include <utility>
#include <vector>

#include "slicer/layers/regions.h"
#include "slicer/layers/run_layer.h"

namespace binderjet {

class ContactFinder {
 public:
  explicit ContactFinder(int first_slice) : slice_(first_slice) {}

  // The next slice up: the target's runs, row by row, with a number for the region of each, and
  // what is printed in it.
  void add(const RunLayer& target, const std::vector<int>& number_of_run, const RunLayer& printed);

  // The bridges by the pair of regions that they join, the lesser first; `region` tells which
  // region a number belongs to in the end. A bridge has the bounds of all straight ways of printed
  // voxels from the one to the other, and the voxels of those along one axis.
  std::map<std::pair<int, int>, Region> contacts(const std::function<int(int)>& region) const;

 private:
  // Columns whose last target voxel was of region `number`, at `last`, and printed on from there.
  struct Way {
    int begin, end, number, last;
  };
  using Ways = std::vector<Way>;

  template <class Found>
  void walk(Ways& ways, std::span<const int> target, const int* numbers,
            std::span<const int> printed, int at, Found found);
  void walk_row(std::span<const int> target, const int* numbers, std::span<const int> printed,
                int y);
  void found(std::size_t axis, int a, int b, const Region& bridge);

  int slice_;
  std::vector<Ways> upward_;  // by row
  Ways spare_;                // walk()'s own, kept for its memory
  std::map<std::pair<int, int>, std::array<Region, 3>> found_;
};

}  // namespace binderjet
