// SPDX-License-Identifier: GPL-3.0-or-later
// One layer of a measured print against what two models predict, as pictures.
#pragma once

#include <cstddef>
#include <vector>

#include "slicer/calibrate/job/measured_job.h"
#include "slicer/model/effects/effect.h"

namespace binderjet {

// Pictures cut to what there is to see, row 0 of the voxel grid first:
//
//   white  powder          red   predicted and not printed
//   gray   both solid      blue  printed and not predicted
struct LayerPictures {
  int layer = 0;                         // its number in the job
  std::vector<std::byte> before, after;  // PNG files
  double width_mm = 0, height_mm = 0;
  double wrong_before = 0, wrong_after = 0;  // |print xor prediction| / |print|, of this layer
};

// Shows the layer in which the second model gains most over the first. Where the second model gains
// nowhere, shows the layer in which the first is most wrong. The print is the job's first; there
// must be one, with a layer.
LayerPictures picture_layer(const MeasuredJob& job, const std::vector<EffectSpec>& before,
                            const std::vector<EffectSpec>& after);

}  // namespace binderjet
