// SPDX-License-Identifier: GPL-3.0-or-later
// Where a scan lies on the job: one shift and one turn about z for the whole stack.
//
// Gauss-Newton on smooth layer images, coarse to fine, at the edges that were predicted; what was
// printed differently (a slot that closed) is weighed down. Scale is fitted along, so that it does
// not lean on the pose, but is only reported: a printer that prints too large is an effect.
#pragma once

#include <array>
#include <span>

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
                           const StackInfo& frame, const std::string& where);

}  // namespace binderjet
