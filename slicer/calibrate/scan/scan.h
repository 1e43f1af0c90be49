// SPDX-License-Identifier: GPL-3.0-or-later
// A scan as slices of smooth values, and where it lies on the job.
#pragma once

#include <array>
#include <functional>

#include "slicer/calibrate/scan/gray_image.h"
#include "slicer/stack/slice_stack.h"

namespace binderjet {

// A point p of the job is found in the scan at R(turn) (p - center) + center + shift.
struct Pose {
  std::array<double, 2> center_mm{};  // of the job's box
  std::array<double, 3> shift_mm{};
  double turn_deg = 0;  // counter-clockwise seen from above

  std::array<double, 2> in_scan(double x_mm, double y_mm) const;
};

// The slices of a scan: `info` has their grid, slice(k) their values. Threads may ask for
// different slices at once.
struct Scan {
  StackInfo info;
  std::function<GrayPlane(int)> slice;

  // Whether the scan's slices are the frame's layers, one for one.
  bool has_layers_of(const StackInfo& frame) const;
  // The mean over the heights [low, high) mm; powder outside the scan.
  GrayPlane mean(double low_mm, double high_mm) const;
};

}  // namespace binderjet
