// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/enhance/tile_surroundings.h"

namespace binderjet {

void TileSurroundings::look_at(const LocalDose& dose) {
  const auto slices = static_cast<int>(layer_at(layers_, 0)->target->slices.size());
  for (const int offset : offsets_.printed) {
    const InverseLayer* layer = layer_at(layers_, offset);
    Plane<int>& cost = costs_[offset];
    // Nobody asks what is printed beyond the job's ends.
    cost.reset(dose.voxel_rect(), layer == nullptr ? 0 : slices);
    if (layer == nullptr) continue;
    for (const RunLayer& slice : layer->target->slices) add_layer(slice, -2, cost);
    if (offset != 0 || layer->stressed.empty()) continue;
    stressed_ = cost;
    for (const Shared<LayerFeatures>& features : layer->stressed) {
      for (const RunLayer& slice : features->lost) add_layer(slice, -kStress, *stressed_);
      for (const RunLayer& slice : features->fused) add_layer(slice, kStress, *stressed_);
    }
  }
  for (const int offset : offsets_.masks) {
    if (offset == 0) continue;
    Plane<std::uint8_t>& mask = masks_[offset];
    mask.reset(dose.mask_rect(), 0);
    const InverseLayer* layer = layer_at(layers_, offset);
    if (layer != nullptr) add_layer(*layer->mask, std::uint8_t{1}, mask);
  }
}

}  // namespace binderjet
