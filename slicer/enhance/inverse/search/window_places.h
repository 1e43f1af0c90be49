// SPDX-License-Identifier: GPL-3.0-or-later
// What the place on the bed does to the layers of a window: shifts of their masks, gains of their
// dose. Density is that of the masks when this is made: a search does not follow how its own flips
// change it, so models with density improve each layer twice.
#pragma once

#include <array>
#include <map>

#include "slicer/enhance/inverse/search/inverse_layer.h"
#include "slicer/layers/grid.h"
#include "slicer/model/dose/density_field.h"
#include "slicer/model/dose/shifted_mask.h"
#include "slicer/model/printer_model.h"

namespace binderjet {

class WindowPlaces {
 public:
  // Model and grid must outlive this.
  WindowPlaces(const PrinterModel& model, const Grid& grid, const LayerWindow& layers,
               const ModelOffsets& offsets);

  // Null if no mask is shifted; then nor is any other.
  const ShiftedMask* shifts(int offset) const;
  std::array<int, 2> max_shift_vx() const;
  bool has_gains() const { return !model_.form().placed.gains.empty(); }
  // Of a voxel of a layer whose print the middle one's mask changes.
  double gain(int offset, int x_vx, int y_vx) const;

 private:
  const PrinterModel& model_;
  const Grid& grid_;
  int number_;  // of the middle layer
  std::map<int, ShiftedMask> shifts_;
  std::map<int, DensityField> densities_;
};

}  // namespace binderjet
