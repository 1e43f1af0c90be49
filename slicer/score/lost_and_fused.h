// SPDX-License-Identifier: GPL-3.0-or-later
// The voxels of a layer that a print loses or fuses: whole features, not skins that are a little
// thin or thick (slicer/MODEL.md, Faults).
//
// Lost: a target voxel that is not printed is worn, and not lost, where a path within the target
// leads to a printed one: within its slice at most kWornMm along x and along y (whole voxels,
// rounded down), then straight up or down into the layer beside, at most one. A target voxel that
// is neither printed nor worn is lost. A row through a wall, '#' printed, 'w'
// worn, 'L' lost, for a kWornMm of two voxels:
//
//   target   ..##########..     ..##########..
//   printed  ....######....     ..####........
//   voxels   ..ww######ww..     ..####wwLLLL..
//
// A pin of which nothing is left is lost as a whole, a wall that came out thinner is not, nor is a
// spike that broke off unless more than kWornMm of it is gone.
//
// Fused: the same with powder in the place of the target and bare powder in the place of what is
// printed. A slot or hole that closed is fused, a slot that came out narrower is not.
//
// kWornMm does not depend on the model, so figures of two models or prints can be compared. A box
// as wide as the paper's (0.7 mm) moves no straight edge by more at levels from 0.15 to 0.85.
#pragma once

#include <vector>

#include "slicer/layers/grid.h"
#include "slicer/layers/run_layer.h"
#include "slicer/layers/stream.h"
#include "slicer/voxels/voxelize.h"

namespace binderjet {

constexpr double kWornMm = 0.25;

// A layer as it was wanted and as it is printed.
struct ComparedLayer {
  Shared<VoxelLayer> target;
  Shared<RunLayer> printed;
};

// The voxels of each slice that are lost, and those that are fused.
struct LostAndFused {
  std::vector<RunLayer> lost;
  std::vector<RunLayer> fused;
};

// Of the middle one of three layers; null neighbors are powder.
LostAndFused find_lost_and_fused(const ComparedLayer* below, const ComparedLayer& layer,
                                 const ComparedLayer* above, const Grid& grid);

}  // namespace binderjet
