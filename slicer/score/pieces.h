// SPDX-License-Identifier: GPL-3.0-or-later
// Parts of the target and pieces of the print, numbered while the layers pass by: a part that comes
// out in several pieces has loose ones, a piece that holds several parts has joined them
// (slicer/MODEL.md, Faults).
//
// Runs of target and print get the numbers of their regions, slice after slice. Where a run of the
// target and a run of the print share a voxel, the pair (part, piece) is noted: a part in two pairs
// is in pieces, a piece in two pairs joins.
//
// WARNING: unlike RegionFinder, which forgets a region at its end, this keeps a number for every
// region until the end, so memory grows with how many regions a job has (not with their size).
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <vector>

#include "slicer/layers/regions.h"
#include "slicer/layers/run_layer.h"
#include "slicer/score/contacts.h"
#include "slicer/voxels/voxelize.h"

namespace binderjet {

// Numbers the regions of a volume, voxels that touch by faces, slice after slice. A region keeps
// its number; two that meet become one with two numbers.
class RegionNumbers {
 public:
  explicit RegionNumbers(int first_slice) : slice_(first_slice) {}

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
  int slice_;
  std::vector<int> parent_;     // by number; itself at the root
  std::vector<Region> region_;  // by number: the runs that were given it
};

// Where the print joins parts is searched for on the way, or not.
enum class Contacts { kFind, kIgnore };

// A part is a connected region of the target, a piece one of the print. All regions are in voxels
// and slices.
class PieceFinder {
 public:
  PieceFinder(int slices_per_layer, int first_layer, Contacts contacts);

  // The next layer up; the slices of the target print as one. Returns the numbers of the printed
  // runs' pieces, row by row, valid until the next call.
  const std::vector<int>& add(const VoxelLayer& target, const RunLayer& printed);

  // What each part has of each piece, by their roots.
  std::map<int, std::map<int, Region>> pieces_by_part();
  // The number of the piece that this one has become a part of.
  int root(int piece) { return pieces_.root(piece); }

  // The loose pieces: of each part that came out as more than one piece, all pieces but the
  // largest.
  //
  // `goes_on(piece)` is for who has added some layers of a job only: whether the piece may go on
  // beyond them. A piece that goes on is not loose, since what holds it may lie beyond; all other
  // pieces of its part are loose, even the largest.
  std::vector<Region> loose(const std::function<bool(const Region&)>& goes_on = {});
  // Where parts hang together in the print: the bridges between them, or the whole piece where no
  // straight way joins them. Only with Contacts::kFind.
  std::vector<Region> joined();

 private:
  int slices_;  // of a layer
  bool finds_contacts_;
  RegionNumbers parts_;
  RegionNumbers pieces_;
  ContactFinder contacts_;
  int slice_;
  std::vector<std::map<int, Region>> pieces_of_;  // by a part's number, by a piece's
};

}  // namespace binderjet
