// SPDX-License-Identifier: GPL-3.0-or-later
// From a placed mesh to the masks that are sent, as one stream.
#pragma once

#include <functional>
#include <memory>

#include "slicer/layers/grid.h"
#include "slicer/layers/run_layer.h"
#include "slicer/layers/stream.h"
#include "slicer/mesh/mesh.h"
#include "slicer/model/printer_model.h"
#include "slicer/voxels/voxelize.h"

namespace binderjet {

class InverseSolver;  // slicer/enhance/inverse/inverse_solver.h

struct MaskLayer {
  RunLayer mask;              // at the printer grid
  Shared<VoxelLayer> target;  // what it is meant to become
};

// The masks of `layers` as the target is: no enhancement.
std::unique_ptr<Stream<MaskLayer>> plain_masks(std::unique_ptr<Stream<VoxelLayer>> target,
                                               const Grid& grid, LayerRange layers, int job_layers);

// The target's layers from a range that a stream of masks asks for, once.
using TargetFrom = std::function<std::unique_ptr<Stream<VoxelLayer>>(LayerRange)>;

// The masks after `passes` passes of the paper's rule (slicer/enhance/paper/paper_rule.h).
//
// The paper (4.5) holds 2 + rz voxel layers per pass: one done, the current one, and those of the
// next printed layer. Here a pass computes whole printed layers and needs the layer below and the
// one above, so it holds 3 rz voxel layers, and kBlockLayers - 1 more printed layers to keep the
// cores busy; as runs these are smaller than the paper's four layers of voxels. A model whose
// binder crosses layers adds its window_reach() of masks on each side.
std::unique_ptr<Stream<MaskLayer>> paper_masks(const TargetFrom& target_from, const Grid& grid,
                                               LayerRange layers, int job_layers,
                                               const std::shared_ptr<const PrinterModel>& model,
                                               int passes);

// The masks that print nearest to the target (slicer/enhance/inverse/inverse_solver.h). A model
// whose binder crosses layers takes turns: layers that share no print are improved together, twice
// over; so does one whose gains follow the masks' density. Then layers in which features vanish or
// pieces come off are searched again, three times, with their neighbours' prints known. What still
// prints where no part is goes, and what no single layer could set right is mended over many at
// once (slicer/enhance/inverse/repair/mend.h).
std::unique_ptr<Stream<MaskLayer>> inverse_masks(
    const TargetFrom& target_from, LayerRange layers, int job_layers,
    const std::shared_ptr<const InverseSolver>& solver);

// The same from a mesh whose lower corner is at (0, 0, 0).
std::unique_ptr<Stream<MaskLayer>> plain_masks(std::shared_ptr<const Mesh> mesh, const Grid& grid,
                                               const JobBox& box, LayerRange layers);
std::unique_ptr<Stream<MaskLayer>> paper_masks(std::shared_ptr<const Mesh> mesh, const Grid& grid,
                                               const JobBox& box, LayerRange layers,
                                               const std::shared_ptr<const PrinterModel>& model,
                                               int passes);
std::unique_ptr<Stream<MaskLayer>> inverse_masks(
    std::shared_ptr<const Mesh> mesh, const Grid& grid, const JobBox& box, LayerRange layers,
    const std::shared_ptr<const InverseSolver>& solver);

}  // namespace binderjet
