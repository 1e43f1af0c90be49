// SPDX-License-Identifier: GPL-3.0-or-later
// Where a scan lies on the job: one shift and one turn about z for the whole stack.
//
// Gauss-Newton on smooth layer images, coarse to fine, at the edges that were predicted; what was
// printed differently (a slot that closed) is weighed down. Scale is fitted along, so that it does
// not lean on the pose, but is only reported: a printer that prints too large is an effect.
#pragma once

#include <array>
#include <functional>
#include <span>

#include "slicer/calibrate/plane.h"
#include "slicer/run_layer.h"
#include "slicer/stack/slice_stack.h"

namespace binderjet {

// A point p of the job is found in the scan at R(turn) (p - center) + center + shift.
struct Pose {
  std::array<double, 2> center_mm{};  // of the job's box
  std::array<double, 3> shift_mm{};
  double turn_deg = 0;  // counter-clockwise seen from above

  std::array<double, 2> in_scan(double x_mm, double y_mm) const;
};

struct Registration {
  Pose pose;
  std::array<double, 2> scale{1, 1};  // of the scan against the prediction, along the job's x and y
  double misfit = 0;  // rms of (scan - prediction) at the predicted edges, blurred to 0.1 mm
};

// The slices of a scan: `info` has their grid, slice(k) their values. Threads may ask for
// different slices at once.
struct Scan {
  StackInfo info;
  std::function<Plane(int)> slice;

  // Whether the scan's slices are the frame's layers, one for one.
  bool has_layers_of(const StackInfo& frame) const;
  // The mean over the heights [low, high) mm; powder outside the scan.
  Plane mean(double low_mm, double high_mm) const;
};

// `predicted` are the layers of a stack described by `frame`, one per image. A shift in z is looked
// for only where the scan's slices are not the frame's layers, for binder that sinks looks like a
// shift in z. Finds poses up to about 10 degrees and 3 mm from centroid on centroid.
// Error{kBadInput} with `where` if prediction or scan is empty.
Registration register_scan(const Scan& scan, std::span<const RunLayer> predicted,
                           const StackInfo& frame, const std::string& where);

}  // namespace binderjet
