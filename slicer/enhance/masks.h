// SPDX-License-Identifier: GPL-3.0-or-later
// The ways of making masks, each a pipeline from the target's voxels to the masks that are sent;
// slicer/README.md lists their steps.
#pragma once

#include <memory>

#include "slicer/enhance/rules/mask_rules.h"
#include "slicer/layers/grid.h"
#include "slicer/layers/pipeline.h"
#include "slicer/layers/run_layer.h"
#include "slicer/model/printer_model.h"
#include "slicer/voxels/voxelize.h"

namespace binderjet {

class InverseSolver;  // slicer/enhance/inverse/inverse_solver.h

struct MaskLayer {
  RunLayer mask;              // at the printer grid
  Shared<VoxelLayer> target;  // what it is meant to become
  RuleChanges changes;        // what the printer's mask rules took and filled
};

// The masks as the target is: no enhancement.
Pipeline<MaskLayer> plain_masks(const Pipeline<VoxelLayer>& target, const Grid& grid);

// The masks after `passes` passes of the paper's rule (slicer/enhance/paper/paper_rule.h).
//
// The paper (4.5) holds 2 + rz voxel layers per pass: one done, the current one, and those of the
// next printed layer. Here a pass computes whole printed layers and needs the layer below and the
// one above, so it holds 3 rz voxel layers, and kBlockLayers - 1 more printed layers to keep the
// cores busy; as runs these are smaller than the paper's four layers of voxels. A model whose
// binder crosses layers adds its window_reach() of masks on each side.
Pipeline<MaskLayer> paper_masks(const Pipeline<VoxelLayer>& target, const Grid& grid,
                                const std::shared_ptr<const PrinterModel>& model, int passes);

// The masks that print nearest to the target (slicer/enhance/inverse/inverse_solver.h). A model
// whose binder crosses layers takes turns: layers that share no print are improved together, twice
// over; so does one whose gains follow the masks' density. Then layers with lost, fused, spurious
// or loose print are searched again around that, three times, with their neighbors' prints known.
Pipeline<MaskLayer> inverse_masks(const Pipeline<VoxelLayer>& target,
                                  const std::shared_ptr<const InverseSolver>& solver);

// Any of these without islands and holes that are too small for the printer: the last word on what
// is sent, whatever way the masks were made. Inverse masks obey before, so theirs stay.
Pipeline<MaskLayer> obeying_masks(const Pipeline<MaskLayer>& masks, const MaskRules& rules);

}  // namespace binderjet
