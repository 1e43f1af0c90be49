// SPDX-License-Identifier: GPL-3.0-or-later
// Parts that come out of the powder in several pieces, and parts that come out as one: found while
// the layers pass by.
#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <vector>

#include "slicer/contacts.h"
#include "slicer/regions.h"
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
  // What each region holds, by its root; other numbers have no voxels.
  std::vector<Region> regions();

 private:
  void take(int& own, int other);

  RunLayer last_;  // the slice added last
  std::vector<int> of_run_;
  int slice_ = 0;
  std::vector<int> parent_;     // by number; itself at the root
  std::vector<Region> region_;  // by number: the runs that were given it
};

// All regions are in voxels and slices.
class PieceCounter {
 public:
  // The next layer up; the slices of the target print as one.
  void add(const VoxelLayer& target, const RunLayer& printed);
  // Connected regions of the target that more than one connected region of the print has voxels
  // of.
  std::int64_t separated();
  // What comes off those: the pieces of each but its largest.
  std::vector<Region> loose_pieces();
  // Where connected regions of the target hang together in the print: the bridges between them, or
  // the whole piece where no straight way joins them.
  std::vector<Region> joints();

 private:
  // The pieces, by their roots, that each part has, by its root.
  std::map<int, std::set<int>> pieces_by_part();

  int slices_ = 0;  // of a layer
  RegionNumbers parts_;
  RegionNumbers pieces_;
  ContactFinder contacts_;
  std::vector<std::set<int>> pieces_of_;  // by a part's number
};

}  // namespace binderjet
