// SPDX-License-Identifier: GPL-3.0-or-later
// Rescue: a layer that prints well voxel by voxel may still lose a feature, or print it in pieces.
//
// Where it does, its mask is searched again with those voxels stressed, from several starts,
// and the mask with the least faults stays. A feature that spans layers is rescued layer after
// layer, so what a round counts differs: printed at all comes first, then in one piece.
#pragma once

#include <map>
#include <span>

#include "slicer/enhance/inverse/search/inverse_layer.h"
#include "slicer/enhance/inverse/search/layer_search.h"

namespace binderjet {

enum class RescueAim {
  features,  // lost, fused and spurious
  pieces,    // and loose
};

// The middle layer with fewer faults, if it has any and no layer gets worse than with plain masks.
// `window` holds the nominal model and those that the printer may drift to.
InverseLayer rescued(const SearchModel& by, std::span<const PrinterModel> window,
                     LayerWindow layers, RescueAim aim);

}  // namespace binderjet
