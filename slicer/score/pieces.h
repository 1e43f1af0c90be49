// SPDX-License-Identifier: GPL-3.0-or-later
// Parts that come out of the powder in several pieces, and parts that come out as one: found while
// the layers pass by.
#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <map>
#include <set>
#include <vector>

#include "slicer/layers/regions.h"
#include "slicer/layers/rows.h"
#include "slicer/layers/run_layer.h"
#include "slicer/score/contacts.h"
#include "slicer/voxels/voxelize.h"

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

// Calls take(part, piece, first, last, y) for each stretch of row y that lies in a run of the
// target and in one of the print, with their numbers.
template <class Take>
void for_each_shared(const RunLayer& target, const std::vector<int>& parts, const RunLayer& printed,
                     const std::vector<int>& pieces, Take take) {
  std::size_t part_begin = 0;
  std::size_t piece_begin = 0;
  for (int y = 0; y < target.height(); ++y) {
    const rows::Row wanted = target.row(y);
    const rows::Row row = printed.row(y);
    rows::for_each_overlap(wanted, row, [&](std::size_t i, std::size_t j) {
      take(parts[part_begin + i], pieces[piece_begin + j], std::max(wanted[2 * i], row[2 * j]),
           std::min(wanted[2 * i + 1], row[2 * j + 1]), y);
    });
    part_begin += wanted.size() / 2;
    piece_begin += row.size() / 2;
  }
}

// All regions are in voxels and slices.
class PieceCounter {
 public:
  // The next layer up; the slices of the target print as one.
  void add(const VoxelLayer& target, const RunLayer& printed);
  // Connected regions of the target that more than one connected region of the print has voxels
  // of.
  std::int64_t separated();
  // What comes off those: the pieces of each but its largest. Who has added a part of a job only
  // says which regions may go on beyond it: they are none, and what comes off them is loose
  // whatever its size.
  using GoesOn = std::function<bool(const Region&)>;
  std::vector<Region> loose_pieces(const GoesOn& goes_on = {});
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
