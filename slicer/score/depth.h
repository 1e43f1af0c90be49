// SPDX-License-Identifier: GPL-3.0-or-later
// Depth: how far from the target's surface the print is wrong (slicer/MODEL.md, Scores).
//
// The depth of a wrong voxel is the distance, in three dimensions, from its center to the target's
// surface (slicer/score/surface_distance.h). A part that came out 0.1 mm thin is wrong everywhere,
// and nowhere deeper than 0.1 mm.
//
// What the layer height cannot avoid has no depth: all slices of a layer print alike, so in a
// column whose slices differ some are wrong whatever is printed. Its wrong slices count where the
// other choice would have been better, that is, where they are more than half of the column's
// slices:
//
//   slice  2   #  #  .                of a column's three slices, # solid
//   slice  1   #  .  .
//   slice  0   #  #  #
//   printed    #  #  #                column 0 is right, column 1 as good as can be, and column 2
//   counts     -  -  1, 2             counts with its two wrong slices
//
// What is left out so lies less than a layer's height from the surface: the slices of its column
// that are right have the other state.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "slicer/layers/grid.h"
#include "slicer/layers/window.h"
#include "slicer/score/lost_and_fused.h"
#include "slicer/score/surface_distance.h"

namespace binderjet {

// Wrong voxels of a lost feature, of a fused gap, and else of a part that is thinner or thicker
// than it should be.
enum class WrongKind { kLost, kFused, kMissing, kExtra };
std::string_view word(WrongKind kind);

struct WrongPlace {
  double depth_mm = 0;
  std::array<int, 3> voxel{};  // x, y and slice, from those of layer 0
  WrongKind kind = WrongKind::kLost;
};
// By depth; of equals what is lost or fused first, then the lowest.
bool deeper(const WrongPlace& a, const WrongPlace& b);

// The depths of wrong voxels; they add up over layers, from the lowest on.
class Depths {
 public:
  // A depth of this much stands for this much or more.
  static constexpr double kMaxMm = 2;

  // Of a layer on this grid. Without one it is empty, and is there to be assigned to.
  explicit Depths(const Grid& grid = {});

  // Wrong voxels of one kind side by side: the first, whose depth_mm is not read, and the depth of
  // each.
  void add(WrongPlace first, std::span<const double> depths_mm);
  Depths& operator+=(const Depths& other);

  std::int64_t count() const { return count_; }  // of the voxels that count
  // The least depth that 99.9 % of the voxels do not exceed, to 1 um; 0 without any.
  double p999_mm() const;
  // The first by deeper(); none if no voxel counts.
  const std::optional<WrongPlace>& worst() const { return worst_; }
  // What is not as deep is not worth a name: the largest side of a pixel of a layer, in mm.
  double named_mm() const { return named_mm_; }
  // At most `most` places that are deeper than named_mm(), the deepest first. What is missing and
  // hangs together in steps of a millimeter is one place, its deepest voxel; so is what is extra.
  std::vector<WrongPlace> places(std::size_t most) const;

 private:
  static constexpr double kCellMm = 1;
  static constexpr std::size_t kMaxCells = 20000;  // memory: two million bytes
  // What hangs together: missing or extra, and a cube of kCellMm.
  using Cell = std::array<int, 4>;

  int cell_along(std::size_t axis, int voxel) const;
  Cell cell_of(const WrongPlace& wrong) const;
  void keep(const WrongPlace& wrong);

  std::array<double, 3> voxel_mm_;
  double named_mm_;
  std::vector<std::int64_t> of_um_;  // voxels by depth, rounded to 1 um
  std::int64_t count_ = 0;
  std::optional<WrongPlace> worst_;
  std::map<Cell, WrongPlace> cells_;  // the deepest voxel of each
};

// Finds the depths of the middle layer `layer`. The window reaches reach() layers; its null
// layers are powder.
class DepthFinder {
 public:
  explicit DepthFinder(const Grid& grid)
      : grid_(grid), reach_slices_(SurfaceDistance::reach_slices(grid, Depths::kMaxMm)) {}

  LayerReach reach() const;
  Depths find(int layer, const Window<ComparedLayer>& window, const LostAndFused& missing) const;

 private:
  Grid grid_;
  int reach_slices_;
};

}  // namespace binderjet
