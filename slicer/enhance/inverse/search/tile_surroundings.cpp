// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/enhance/inverse/search/tile_surroundings.h"

namespace binderjet {

void TileSurroundings::look_at(const LocalDose& dose) {
  const auto slices = static_cast<int>(layer_at(layers_, 0)->target->slices.size());
  for (const int offset : offsets_.printed) {
    const InverseLayer* layer = layer_at(layers_, offset);
    Plane<int>& cost = costs_[offset];
    // Nobody asks what is printed beyond the job's ends.
    cost.reset(dose.voxel_rect(), layer == nullptr ? 0 : slices);
    find_gains(offset, dose.voxel_rect());
    if (layer == nullptr) continue;
    for (const RunLayer& slice : layer->target->slices) add_layer(slice, -2, cost);
    for (const Shared<LayerFaults>& faults : layer->stressed) {
      add_layer(faults->spurious, kStress, cost);
    }
    if (layer->stressed.empty()) continue;
    Plane<int>& stressed = stressed_[offset] = cost;
    for (const Shared<LayerFaults>& faults : layer->stressed) {
      for (const RunLayer& slice : faults->missing.lost) add_layer(slice, -kStress, stressed);
      for (const RunLayer& slice : faults->missing.fused) add_layer(slice, kStress, stressed);
      add_layer(faults->pieces.gap, -kStress, stressed);
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

void TileSurroundings::find_gains(int offset, const Rect& voxels) {
  if (!places_.has_gains()) return;
  Plane<float>& gains = gains_[offset];
  gains.reset(voxels, 1);
  if (layer_at(layers_, offset) == nullptr) return;
  for (int y = voxels.y0; y < voxels.y1; ++y) {
    float* gain = gains.at(voxels.x0, y);
    for (int x = voxels.x0; x < voxels.x1; ++x) {
      *gain++ = static_cast<float>(places_.gain(offset, x, y));
    }
  }
}

}  // namespace binderjet
