// SPDX-License-Identifier: GPL-3.0-or-later
// Mesh to voxels: a voxel is inside iff the surface winds around its center (slicer/MODEL.md,
// Grids).
//
// Each slice is a plane cut through the mesh (paper, 4.1). The cut crosses the line of centers of a
// row at some places, up (+1) or down (-1); along the row the sum of the crossings is the winding
// number, and the row is 1 where that is not 0:
//
//   crossings     +1    +1      -1   -1
//   winding     0     1      2     1     0
//   row         ..####################...    even-odd would leave a hole where the winding is 2
//
// Triangles are sorted by their lowest point and are active while the slices rise through them.
// Memory is the mesh, the active list and the slices asked for.
#pragma once

#include <memory>
#include <vector>

#include "slicer/base/work.h"
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
                                  const JobBox& box, const Work& work = {});

}  // namespace binderjet
