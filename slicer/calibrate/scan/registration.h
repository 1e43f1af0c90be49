// SPDX-License-Identifier: GPL-3.0-or-later
// Where a scan lies on the job: one shift and one turn about z for the whole stack.
//
// Gauss-Newton on blurred layer images I, at points p of the predicted edges:
//
//   scan(p) - prediction(p) = slope(p) . e      one linear system for the small motion e
//
// from coarse to fine (blurred by 0.8, 0.3, 0.1 mm). A large difference is weighed down (Tukey): a
// slot that closed is no motion. Scale and the growth of faces are fitted along, for else the pose
// would take them up on a part that is not symmetric; scale is reported and growth is forgotten,
// since a printer that prints too large is an effect and no matter of the pose.
#pragma once

#include <array>
#include <span>

#include "slicer/base/work.h"
#include "slicer/calibrate/scan/scan.h"
#include "slicer/layers/run_layer.h"
#include "slicer/stack/slice_stack.h"

namespace binderjet {

struct Registration {
  Pose pose;
  std::array<double, 2> scale{1, 1};  // of the scan against the prediction, along the job's x and y
  double misfit = 0;  // rms of (scan - prediction) at the predicted edges, blurred to 0.1 mm
};

// `predicted` are the layers of a stack described by `frame`, one per image. A shift in z is looked
// for only where the scan's slices are not the frame's layers, for binder that sinks looks like a
// shift in z. Finds poses up to about 10 degrees and 3 mm from centroid on centroid.
// Error{kBadInput} with `where` if prediction or scan is empty.
Registration register_scan(const Scan& scan, std::span<const RunLayer> predicted,
                           const StackInfo& frame, const std::string& where, const Work& work = {});

}  // namespace binderjet
