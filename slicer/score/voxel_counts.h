// SPDX-License-Identifier: GPL-3.0-or-later
// How far the printed voxels are from the target (slicer/MODEL.md, Scores), added up
// layer by layer.
#pragma once

#include <cstdint>

#include "slicer/layers/run_layer.h"
#include "slicer/voxels/voxelize.h"

namespace binderjet {

// Counts of voxels; they add up over rows, layers and shares.
struct VoxelCounts {
  std::int64_t solid = 0;        // |target|
  std::int64_t missing = 0;      // target, not printed
  std::int64_t extra = 0;        // printed, not target
  std::int64_t unavoidable = 0;  // wrong whatever the mask: one mask serves rz slices

  VoxelCounts& operator+=(const VoxelCounts& other);
  double wrong() const;   // |printed xor target| / |target|
  double floor() const;   // unavoidable / |target|
  double excess() const;  // wrong - floor
};

// One layer; `printed` is equal for all slices of the target.
VoxelCounts count_voxels(const VoxelLayer& target, const RunLayer& printed);

}  // namespace binderjet
