// SPDX-License-Identifier: GPL-3.0-or-later
// A layer on its way through the inverse solver, and what a window of layers prints.
#pragma once

#include <cstdint>
#include <set>
#include <vector>

#include "slicer/enhance/inverse/search/breaks.h"
#include "slicer/layers/run_layer.h"
#include "slicer/layers/window.h"
#include "slicer/model/printer_model.h"
#include "slicer/score/features.h"
#include "slicer/voxels/voxelize.h"

namespace binderjet {

// What is wrong with a layer's print beyond single voxels.
struct LayerFaults {
  LayerFeatures gone;  // lost and fused, under the nominal model
  RunLayer barren;     // printed where no part is, under any model of the window
  Breaks breaks;       // seen from the layers beside it, under the nominal model
};

// Shared, for most steps change one of its parts only.
struct InverseLayer {
  Shared<VoxelLayer> target;
  Shared<RunLayer> plain;  // its mask without enhancement
  Shared<RunLayer> mask;   // its mask so far; obeys the rules
  // Faults that its print has had before and shall not have again.
  std::vector<Shared<LayerFaults>> stressed;
  int number = 0;  // in the job, from 0 on the bed
};

// As many layers on each side of the one that is worked on.
using LayerWindow = Window<InverseLayer>;

inline const InverseLayer* layer_at(const LayerWindow& layers, int offset) {
  return layers.at(offset);
}

// The layers whose print the mask of the middle one changes, and those whose masks have a part in
// that print, as offsets.
struct ModelOffsets {
  std::set<int> printed;
  std::set<int> masks;
};
ModelOffsets offsets_of(const AssembledModel& form);

// The masks so far that the model wants to see for the layer at `offset`.
RunWindow masks_around(LayerWindow layers, int offset, const PrinterModel& model);

// What becomes of the layer at `offset`, which must be there: with the plain masks, and with those
// so far but `own` for the middle layer.
RunLayer print_plain(LayerWindow layers, int offset, const PrinterModel& model);
RunLayer print_with(LayerWindow layers, int offset, const PrinterModel& model, const RunLayer& own);

// Voxels of all its slices that come out wrong.
std::int64_t wrong_voxels(const InverseLayer& layer, const RunLayer& printed);
// Whether with this mask for the middle layer none of the layers that it prints into has more wrong
// voxels than with plain masks, or than it has now.
bool no_worse_than_plain(LayerWindow layers, const PrinterModel& model, const ModelOffsets& offsets,
                         const RunLayer& own);

}  // namespace binderjet
