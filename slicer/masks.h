// SPDX-License-Identifier: GPL-3.0-or-later
// From a placed mesh to the masks that are sent, as one stream.
#pragma once

#include <cstdint>
#include <memory>

#include "slicer/grid.h"
#include "slicer/mesh.h"
#include "slicer/run_layer.h"
#include "slicer/stream.h"

namespace binderjet {

struct MaskLayer {
  RunLayer mask;                // at the printer grid
  std::int64_t target_vx = 0;  // solid voxels of the target in this layer
};

// The masks of `layers` of a part whose lower corner is at (0, 0, 0).
std::unique_ptr<Stream<MaskLayer>> masks(std::shared_ptr<const Mesh> mesh, const Grid& grid,
                                         const JobBox& box, LayerRange layers);

}  // namespace binderjet
