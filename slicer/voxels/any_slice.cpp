// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/voxels/any_slice.h"

#include <utility>
#include <vector>

#include "slicer/layers/rows.h"

namespace binderjet {

RunLayer any_slice(const VoxelLayer& layer) {
  RunLayer out = layer.slices.front();
  std::vector<int> row;
  for (std::size_t s = 1; s < layer.slices.size(); ++s) {
    RunLayer both(out.width());
    for (int y = 0; y < out.height(); ++y) {
      rows::unite(out.row(y), layer.slices[s].row(y), row);
      both.append_row(row);
    }
    out = std::move(both);
  }
  return out;
}

}  // namespace binderjet
