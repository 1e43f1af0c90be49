// SPDX-License-Identifier: GPL-3.0-or-later
// The printer model: the ordered effects of a profile as one function from masks to printed voxels.
#pragma once

#include <cstdint>
#include <vector>

#include "slicer/box_filter.h"
#include "slicer/effects/effect.h"
#include "slicer/grid.h"
#include "slicer/run_layer.h"

namespace binderjet {

// What the effects of a model add up to. Each effect's forward form writes its share into it.
struct ModelForm {
  BoxWeights spread_x;  // dose = mask repeated to the voxel grid, filtered with this box
  BoxWeights spread_y;
  double level = 0;  // a voxel is bound iff its dose is at least this; 0: no effect has said so
  // Bound powder that holds no such box (voxels in x and y) is brushed off.
  std::vector<std::array<int, 2>> survive_vx;
};

class PrinterModel {
 public:
  // Error{kBadInput} if the effects are no whole model (nothing binds, or binds twice).
  PrinterModel(const std::vector<EffectSpec>& effects, const Grid& grid);

  const Reach& reach() const { return reach_; }
  // The printed voxels of a layer, at the voxel grid in x and y; all its rz slices are equal.
  RunLayer print(const RunLayer& mask) const;

 private:
  std::array<int, 2> repeat_;
  Reach reach_;
  ModelForm form_;
  std::int64_t least_;
};

}  // namespace binderjet
