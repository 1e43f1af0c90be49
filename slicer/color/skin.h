// SPDX-License-Identifier: GPL-3.0-or-later
// The colored skin of a part: pixels that hold boundary voxels of the target, each with the mean
// color of these voxels (paper, 4.4).
#pragma once

#include <memory>
#include <vector>

#include "slicer/color/field.h"
#include "slicer/enhance/masks.h"
#include "slicer/layers/grid.h"
#include "slicer/layers/stream.h"

namespace binderjet {

struct SkinLayer {
  Shared<MaskLayer> masks;
  RunLayer pixels;                // at the printer grid
  std::vector<std::size_t> rows;  // the first color of each row
  std::vector<Rgb> colors;        // of the pixels, row by row
};

// `masks` must begin one layer before `layers` and end one after, or at the job's ends.
std::unique_ptr<Stream<SkinLayer>> skin(std::unique_ptr<Stream<MaskLayer>> masks, const Grid& grid,
                                        const JobBox& box, LayerRange layers,
                                        std::shared_ptr<const ColorField> field);

}  // namespace binderjet
