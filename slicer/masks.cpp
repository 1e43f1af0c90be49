// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/masks.h"

#include <utility>

#include "slicer/slicing_operator.h"
#include "slicer/voxelize.h"

namespace binderjet {

std::unique_ptr<Stream<MaskLayer>> masks(std::shared_ptr<const Mesh> mesh, const Grid& grid,
                                         const JobBox& box, LayerRange layers) {
  using Slicing = Step<VoxelLayer, MaskLayer>;
  return std::make_unique<Slicing>(
      voxelize(std::move(mesh), grid, box, layers), layers, 0, box.size_px[2],
      [grid](int, Slicing::Window window) {
        const VoxelLayer& voxels = *window.front();
        MaskLayer out{slicing_operator(voxels, grid), 0};
        for (const RunLayer& slice : voxels.slices) out.target_vx += slice.count();
        return out;
      });
}

}  // namespace binderjet
