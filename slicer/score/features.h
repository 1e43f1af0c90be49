// SPDX-License-Identifier: GPL-3.0-or-later
// What a print loses, fuses and adds: whole features, not skins that are a little thin or thick.
//
// Lost: a target voxel is worn where it is not printed but a path within the target leads to a
// voxel that is printed: at most one layer up or down, and at most kWornMm along x and along y. A
// target voxel that is neither printed nor worn is lost; `lost` counts the connected regions (by
// faces, in 3-D) of lost voxels. A pin of which nothing is left is one, a wall that came out
// thinner is none, a spike that broke off is one if more than kWornMm of it is gone.
//
// Fused: the same with powder in the place of the target and bare powder in the place of what is
// printed. A slot or hole that closed is one, a slot that came out narrower is none.
//
// Spurious: connected printed regions that hold no target voxel.
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

// The voxels of each slice that are lost, or fused.
struct LayerFeatures {
  std::vector<RunLayer> lost;
  std::vector<RunLayer> fused;
};

// Of the middle one of three layers; null neighbours are powder.
LayerFeatures find_features(const ComparedLayer* below, const ComparedLayer& layer,
                            const ComparedLayer* above, const Grid& grid);

}  // namespace binderjet
