// SPDX-License-Identifier: GPL-3.0-or-later
// What in a printer model depends on where on the bed a voxel is: gains of the dose, shifts of the
// mask, weak first drops of a line (slicer/MODEL.md, Printer model). A model without any of these
// prints the same anywhere.
#pragma once

#include <algorithm>
#include <array>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "slicer/layers/grid.h"
#include "slicer/model/dose/density_field.h"

namespace binderjet {

// A place on the bed, in the middle of a voxel or of a mask row.
struct Spot {
  double x_mm = 0;
  double y_mm = 0;
  double z_mm = 0;  // the middle of its layer
  int layer = 0;
  double density = 0;  // the share of solid masks around it, where BedDependence asks for it
};

// The dose is multiplied by max(0, 1 + amount(spot)).
struct DoseGain {
  std::function<double(const Spot&)> amount;
  double most;  // |amount| is nowhere larger
};

// Binder meant for a spot lands by_mm(spot) beside it. Along y a mask row is shifted as a whole, by
// the amount at its middle, so that rows stay rows.
struct MaskShift {
  std::function<std::array<double, 2>(const Spot&)> by_mm;
  double max_mm;  // neither component is larger within 1 m
};

struct BedDependence {
  std::vector<DoseGain> gains;
  std::vector<MaskShift> shifts;
  // Half the width of the box whose solid share is Spot::density; in z whole layers.
  std::optional<double> density_radius_mm;
  // What the first pixels of a line along x lack of their binder, as shares of it; of the row's
  // first run only, or after each gap.
  std::vector<double> weak_drops;
  bool weak_after_gaps = false;

  double gain_at(const Spot& spot) const {
    double gain = 1;
    for (const DoseGain& factor : gains) gain *= std::max(0.0, 1 + factor.amount(spot));
    return gain;
  }
  std::array<double, 2> shift_at(const Spot& spot) const {
    std::array<double, 2> sum{};
    for (const MaskShift& shift : shifts) {
      const std::array<double, 2> by = shift.by_mm(spot);
      for (std::size_t axis = 0; axis < 2; ++axis) sum[axis] += by[axis];
    }
    return sum;
  }
  // No mask is shifted by more voxels than this.
  int max_shift_vx(const Grid& grid, int axis) const {
    double sum = 0;
    for (const MaskShift& shift : shifts) sum += shift.max_mm;
    return pixels_for(sum, grid.voxel_mm(axis));
  }
  // Calls take(pixel, share): from this pixel of a mask row on, binder is weaker by this share of a
  // full pixel's than just before.
  template <class Take>
  void for_each_weakening(std::span<const int> row, Take take) const {
    if (weak_drops.empty()) return;
    const std::size_t flips = weak_after_gaps ? row.size() : std::min<std::size_t>(2, row.size());
    for (std::size_t i = 0; i < flips; i += 2) {
      const auto count = std::min(weak_drops.size(), static_cast<std::size_t>(row[i + 1] - row[i]));
      double before = 0;
      for (std::size_t pixel = 0; pixel < count; ++pixel) {
        take(row[i] + static_cast<int>(pixel), weak_drops[pixel] - before);
        before = weak_drops[pixel];
      }
      take(row[i] + static_cast<int>(count), -before);
    }
  }
  int density_layers(const Grid& grid) const {
    return density_radius_mm ? pixels_for(*density_radius_mm, grid.pitch_mm[2]) : 0;
  }
};

// How far a spot is from the side of the job's box; 0 outside.
inline double edge_distance(const JobPlace& place, const Spot& spot) {
  const double x = spot.x_mm - place.origin_mm[0];
  const double y = spot.y_mm - place.origin_mm[1];
  return std::max(0.0, std::min({x, place.size_mm[0] - x, y, place.size_mm[1] - y}));
}

// The middle of voxel (x, y) of a layer of a job that stands at `place`.
inline Spot spot_at(const Grid& grid, const JobPlace& place, double x_vx, double y_vx, int layer) {
  return {place.origin_mm[0] + (x_vx + 0.5) * grid.voxel_mm(0),
          place.origin_mm[1] + (y_vx + 0.5) * grid.voxel_mm(1), (layer + 0.5) * grid.pitch_mm[2],
          layer, 0};
}

// Of the middle layer of a window of masks (null is powder) that reaches at least
// placed.density_layers(); none if no effect asks for it.
inline std::optional<DensityField> density_of(const RunWindow& window, const Grid& grid,
                                              const BedDependence& placed) {
  if (!placed.density_radius_mm) return std::nullopt;
  return DensityField(window.part(0, placed.density_layers(grid)), grid, *placed.density_radius_mm);
}

// By what the dose of voxel (x, y) of a layer is multiplied; `density` may be null if no effect
// asks for it.
inline double gain_at_voxel(const Grid& grid, const JobPlace& place, const BedDependence& placed,
                            const DensityField* density, int x_vx, int y_vx, int layer) {
  Spot spot = spot_at(grid, place, x_vx, y_vx, layer);
  if (density != nullptr) spot.density = density->at(x_vx, y_vx);
  return placed.gain_at(spot);
}

}  // namespace binderjet
