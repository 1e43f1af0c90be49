// SPDX-License-Identifier: GPL-3.0-or-later
// The colored skin of a part: pixels that hold boundary voxels of the target, each with the mean
// color of these voxels (paper, 4.4).
#pragma once

#include <memory>
#include <vector>

#include "slicer/color/field.h"
#include "slicer/enhance/masks.h"
#include "slicer/layers/grid.h"
#include "slicer/layers/pipeline.h"

namespace binderjet {

struct SkinLayer {
  Shared<MaskLayer> masks;
  RunLayer pixels;                // at the printer grid
  std::vector<std::size_t> rows;  // the first color of each row
  std::vector<Rgb> colors;        // of the pixels, row by row
};

Pipeline<SkinLayer> skin(const Pipeline<MaskLayer>& masks, const Grid& grid, const JobBox& box,
                         std::shared_ptr<const ColorField> field);

}  // namespace binderjet
