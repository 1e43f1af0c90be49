// SPDX-License-Identifier: GPL-3.0-or-later
// Mesh to voxels: a voxel is inside iff the surface winds around its centre (DESIGN section 5).
//
// Scan-line from the plane cut of each slice (paper, 4.1): triangles sorted by their lowest point,
// an active list while the slices rise through them, crossings per row, winding number not 0.
// Memory is the mesh, the list and the slices asked for.
#pragma once

#include <memory>
#include <vector>

#include "slicer/layers/grid.h"
#include "slicer/layers/pipeline.h"
#include "slicer/layers/run_layer.h"
#include "slicer/mesh/mesh.h"

namespace binderjet {

// The rz slices of one layer on the voxel grid, lowest first.
struct VoxelLayer {
  std::vector<RunLayer> slices;
};

// The layers `layers` of a part whose lower corner is at (0, 0, 0), in the box `box`.
std::unique_ptr<Stream<VoxelLayer>> voxelize(std::shared_ptr<const Mesh> mesh, const Grid& grid,
                                             const JobBox& box, LayerRange layers);
// All layers of the box, as the beginning of a pipeline.
Pipeline<VoxelLayer> voxel_layers(std::shared_ptr<const Mesh> mesh, const Grid& grid,
                                  const JobBox& box);

}  // namespace binderjet
