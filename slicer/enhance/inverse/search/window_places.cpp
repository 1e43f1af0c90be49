// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/enhance/inverse/search/window_places.h"

#include <optional>
#include <utility>
#include <vector>

namespace binderjet {

WindowPlaces::WindowPlaces(const PrinterModel& model, const Grid& grid, const LayerWindow& layers,
                           const ModelOffsets& offsets)
    : model_(model), grid_(grid), number_(layers.at(0)->number) {
  const AssembledModel& form = model.form();
  const int width = layers.at(0)->mask->width();
  if (!form.placed.shifts.empty()) {
    for (const int offset : offsets.masks) {
      shifts_.emplace(offset, ShiftedMask(grid_, form.place, form.placed, width, number_ + offset));
    }
  }
  for (const int offset : offsets.printed) {
    if (!form.placed.density_radius_mm || layers.at(offset) == nullptr) continue;
    if (auto density = density_of(masks_around(layers, offset, model), grid_, form.placed)) {
      densities_.emplace(offset, *std::move(density));
    }
  }
}

const ShiftedMask* WindowPlaces::shifts(int offset) const {
  return shifts_.empty() ? nullptr : &shifts_.at(offset);
}

std::array<int, 2> WindowPlaces::max_shift_vx() const {
  const BedDependence& placed = model_.form().placed;
  return {placed.max_shift_vx(grid_, 0), placed.max_shift_vx(grid_, 1)};
}

double WindowPlaces::gain(int offset, int x_vx, int y_vx) const {
  const auto density = densities_.find(offset);
  const AssembledModel& form = model_.form();
  return gain_at_voxel(grid_, form.place, form.placed,
                       density == densities_.end() ? nullptr : &density->second, x_vx, y_vx,
                       number_ + offset);
}

}  // namespace binderjet
