// SPDX-License-Identifier: GPL-3.0-or-later
// A layer on its way through the inverse solver, and what a window of layers prints.
#pragma once

#include <cstdint>
#include <set>
#include <vector>

#include "slicer/enhance/inverse/search/loose_in_window.h"
#include "slicer/layers/run_layer.h"
#include "slicer/layers/window.h"
#include "slicer/model/printer_model.h"
#include "slicer/score/faults.h"
#include "slicer/score/lost_and_fused.h"
#include "slicer/voxels/voxelize.h"

namespace binderjet {

// What is wrong with a layer's print beyond single voxels.
struct LayerFaults {
  LostAndFused missing;       // under the nominal model
  std::vector<Fault> faults;  // the regions of `missing` within the layer
  RunLayer spurious;          // under any model of the process window, see spurious_print()
  LooseInWindow pieces;       // seen from the layers beside it, under the nominal model
};

// A step changes one or two members, so the members are shared and a copy is cheap.
struct InverseLayer {
  Shared<VoxelLayer> target;
  Shared<RunLayer> plain;  // its mask without enhancement
  Shared<RunLayer> mask;   // its mask so far; obeys the rules
  // Faults that its print has had in an earlier round; a search must not bring them back.
  std::vector<Shared<LayerFaults>> stressed;
  int number = 0;  // in the job, from 0 on the bed
};

// As many layers on each side of the one that is worked on.
using LayerWindow = Window<InverseLayer>;

inline const InverseLayer* layer_at(const LayerWindow& layers, int offset) {
  return layers.at(offset);
}

// The layers that the middle layer's mask has to do with, as offsets from the middle layer. Where
// binder sinks one layer the print of k takes the masks of k and k + 1, so printed = {-1, 0} and
// masks = {-1, 0, 1}.
struct ModelOffsets {
  std::set<int> printed;  // the layers whose print the mask of the middle layer changes
  std::set<int> masks;    // the layers whose masks have a part in one of those prints
};
ModelOffsets offsets_of(const AssembledModel& form);

// The masks so far that the model wants to see for the layer at `offset`.
RunWindow masks_around(LayerWindow layers, int offset, const PrinterModel& model);

// The print of the layer at `offset`, which must be there, from plain masks.
RunLayer print_plain(LayerWindow layers, int offset, const PrinterModel& model);
// The same from the masks so far, with `own` as the mask of the middle layer.
RunLayer print_with(LayerWindow layers, int offset, const PrinterModel& model, const RunLayer& own);

// The wrong voxels of all slices of the layer.
std::int64_t wrong_voxels(const InverseLayer& layer, const RunLayer& printed);
// Whether `own` may be the mask of the middle layer: no layer that it prints into may have more
// wrong voxels than with plain masks, unless the layer has at least as many now.
bool no_worse_than_plain(LayerWindow layers, const PrinterModel& model, const ModelOffsets& offsets,
                         const RunLayer& own);

}  // namespace binderjet
