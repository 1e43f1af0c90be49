// SPDX-License-Identifier: GPL-3.0-or-later
// What came out of the powder, on the voxel grid of the job: a scan registered and resampled.
//
//   samples of the scan -> half way between the two grays -> pose -> voxel = gray at its middle
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "slicer/base/work.h"
#include "slicer/calibrate/scan/registration.h"
#include "slicer/layers/run_layer.h"
#include "slicer/stack/slice_stack.h"

namespace binderjet {

// The two grays of a scan, from a sample of its slices.
struct Grays {
  double powder = 0;
  double solid = 255;
  double half = 127.5;  // the surface: the stated threshold, or half way between the two
  double noise = 0;     // standard deviation as a share of solid - powder; 0 for a 1-bit stack
};

struct Measured {
  std::vector<RunLayer> layers;  // one per layer of the job, at its voxel grid in x and y
  Grays grays;
  // None where the scan's samples are whole voxels of the job's grid: such a stack is taken as it
  // is, bit for bit where the grids are equal.
  std::optional<Registration> registration;
};

// `frame` describes the printed stack that was predicted for the job (slice_stack.h), and
// `predicted` are its layers. The scan may have any pitch, also in z, gray or 1-bit samples, noise,
// and may be shifted and turned; what it does not cover reads as powder. Grays between the centers
// of samples are interpolated and the surface is where they pass half, so edges keep their place to
// a fraction of a sample. Noise beyond a tenth of the contrast is blurred to that first, or it
// would strew voxels. Error{kBadInput} for a folder that is no such stack. `work` hears of each
// image that is read, and then of each layer.
Measured read_measured(const std::string& folder, const StackInfo& frame,
                       std::span<const RunLayer> predicted, const Work& work = {});

}  // namespace binderjet
