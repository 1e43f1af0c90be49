// SPDX-License-Identifier: GPL-3.0-or-later
// A layer on its way through the inverse solver, and what a window of layers prints.
#pragma once

#include <cstdint>
#include <set>
#include <vector>

#include "slicer/layers/run_layer.h"
#include "slicer/layers/window.h"
#include "slicer/model/printer_model.h"
#include "slicer/voxels/voxelize.h"

namespace binderjet {

struct FoundFaults;

// A step changes one member, so the members are shared and a copy is cheap.
struct InverseLayer {
  Shared<VoxelLayer> target;
  Shared<RunLayer> plain;  // its mask without enhancement
  Shared<RunLayer> mask;   // its mask so far; obeys the rules
  int number = 0;          // in the job, from 0 on the bed
  // What the masks so far print here, and what is broken in it (slicer/enhance/inverse/judge.h);
  // null until somebody asks.
  Shared<RunLayer> printed{};
  Shared<FoundFaults> broken{};
  // The prints that `broken` was found in, and those with which repair found nothing better: as
  // long as they are the same nobody needs to look again. From the layers below up.
  std::vector<Shared<RunLayer>> judged{};
  std::vector<Shared<RunLayer>> settled{};
};

// As many layers on each side of the one that is worked on.
using LayerWindow = Window<InverseLayer>;

// The layers that the middle layer's mask has to do with, as offsets from the middle layer. Where
// binder sinks one layer the print of k takes the masks of k and k + 1, so printed = {-1, 0} and
// masks = {-1, 0, 1}.
struct ModelOffsets {
  std::set<int> printed;  // the layers whose print the mask of the middle layer changes
  std::set<int> masks;    // the layers whose masks have a part in one of those prints
};
ModelOffsets offsets_of(const AssembledModel& form);

// The masks so far that the model wants to see for the layer at `offset`.
RunWindow masks_around(const LayerWindow& layers, int offset, const PrinterModel& model);

// The print of the layer at `offset`, which must be there, from plain masks.
RunLayer print_plain(const LayerWindow& layers, int offset, const PrinterModel& model);
// The same from the masks so far, with `own` as the mask of the middle layer.
RunLayer print_with(const LayerWindow& layers, int offset, const PrinterModel& model,
                    const RunLayer& own);

// The wrong voxels of all slices of the layer.
std::int64_t wrong_voxels(const InverseLayer& layer, const RunLayer& printed);

}  // namespace binderjet
