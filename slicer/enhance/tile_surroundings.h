// SPDX-License-Identifier: GPL-3.0-or-later
// Costs and masks of the layers around one tile, cut out of the layers' runs.
#pragma once

#include <map>
#include <vector>

#include "slicer/enhance/inverse_layer.h"
#include "slicer/enhance/local_dose.h"
#include "slicer/enhance/plane.h"
#include "slicer/features.h"

namespace binderjet {

class TileSurroundings : public Surroundings {
 public:
  // `own` is the mask of the middle layer as it is being improved; all must outlive this.
  TileSurroundings(LayerWindow layers, const ModelOffsets& offsets, const Plane<std::uint8_t>& own)
      : layers_(layers), offsets_(offsets), own_(own) {}

  // Cuts out what this dose asks for. The voxels of a slice that belong to features of the middle
  // layer, as they are here, cost `stress` more when they come out wrong.
  void look_at(const LocalDose& dose, const LayerFeatures& features, int stress);

  const Plane<int>& cost(int layer) const override { return costs_.at(layer); }
  const Plane<std::uint8_t>& mask(int layer) const override {
    return layer == 0 ? own_ : masks_.at(layer);
  }

 private:
  LayerWindow layers_;
  const ModelOffsets& offsets_;
  const Plane<std::uint8_t>& own_;
  std::map<int, Plane<int>> costs_;
  std::map<int, Plane<std::uint8_t>> masks_;
};

}  // namespace binderjet
