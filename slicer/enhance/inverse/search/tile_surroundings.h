// SPDX-License-Identifier: GPL-3.0-or-later
// Costs and masks of the layers around one tile, cut out of the layers' runs.
#pragma once

#include <array>
#include <map>

#include "slicer/enhance/inverse/search/inverse_layer.h"
#include "slicer/enhance/inverse/search/local_dose.h"
#include "slicer/enhance/inverse/search/window_places.h"
#include "slicer/enhance/rules/rect_cells.h"

namespace binderjet {

// What one voxel counts in a search that must set a fault right: more than all voxels that a pixel
// reaches, so that no other gain makes up for it. A voxel of a stressed feature counts this much in
// its slice and under the nominal model; a voxel that must stay powder counts it under all models.
constexpr int kStress = 1000;

class TileSurroundings : public Surroundings {
 public:
  // `own` is the mask of the middle layer as it is being improved; all must outlive this.
  TileSurroundings(LayerWindow layers, const ModelOffsets& offsets, const WindowPlaces& places,
                   const Plane<std::uint8_t>& own)
      : layers_(layers), offsets_(offsets), places_(places), own_(own) {}

  // Cuts out what this dose asks for.
  void look_at(const LocalDose& dose);

  const Plane<int>& cost(int layer, bool nominal) const override {
    const auto stressed = stressed_.find(layer);
    return nominal && stressed != stressed_.end() ? stressed->second : costs_.at(layer);
  }
  const Plane<std::uint8_t>& mask(int layer) const override {
    return layer == 0 ? own_ : masks_.at(layer);
  }
  const ShiftedMask* shifts(int layer) const override { return places_.shifts(layer); }
  std::array<int, 2> max_shift_vx() const override { return places_.max_shift_vx(); }
  const Plane<float>* gain(int layer) const override {
    return places_.has_gains() ? &gains_.at(layer) : nullptr;
  }

 private:
  void find_gains(int offset, const Rect& voxels);

  LayerWindow layers_;
  const ModelOffsets& offsets_;
  const WindowPlaces& places_;
  const Plane<std::uint8_t>& own_;
  std::map<int, Plane<int>> costs_;
  std::map<int, Plane<int>> stressed_;  // with the features that are stressed
  std::map<int, Plane<std::uint8_t>> masks_;
  std::map<int, Plane<float>> gains_;
};

}  // namespace binderjet
