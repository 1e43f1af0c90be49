// SPDX-License-Identifier: GPL-3.0-or-later
// The residual: how much dose a model misses where the measured surface is.
//
//   model's print     # # # # . . . .        edge e of the model
//   measured          # # # # # # . .        the nearest measured edge of the same sign in the row
//   missing(e)        level - dose of the model at the measured edge
//
// At the measured edge the true dose is the level, so `missing` is what the model lacks, in its own
// unit (slicer/MODEL.md, How calibrate chooses). What a candidate would add is looked up at the
// *model's* edge: at the measured one it would be correlated with the noise that put the edge
// there.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "slicer/calibrate/job/measured_job.h"
#include "slicer/calibrate/residual/dose_probe.h"

namespace binderjet {

struct SurfacePoint {
  int layer = 0;  // index into the job's masks
  int x = 0;      // the lower voxel of the two on both sides of the model's edge
  int y = 0;
  int axis = 0;          // 0: the other voxel is at x + 1; 1: at y + 1
  int sign = 1;          // 1: the lower voxel is solid
  double offset_vx = 0;  // how far along the axis the measured edge is, mean of the replicates
  double missing = 0;    // dose, mean of the replicates

  DosePlace place(double offset = 0) const {
    return axis == 0 ? DosePlace{x + 0.5 + offset, static_cast<double>(y)}
                     : DosePlace{static_cast<double>(x), y + 0.5 + offset};
  }
};

// How many points a choice and a fit look at, and how far from the model's edge a measured one may
// be.
constexpr int kChoicePoints = 36000;
constexpr int kFitPoints = 15000;
constexpr double kPairReachMm = 0.45;

// Which layers of a job are looked at: all whose flag is set.
using LayerChoice = std::vector<bool>;

// The window of masks around layer `index`, `reach` on each side; null beyond the job.
RunWindow mask_window(const MeasuredJob& job, int index, int reach);

// What the model prints of the chosen layers; others stay empty.
std::vector<Shared<RunLayer>> print_layers(const MeasuredJob& job,
                                           const std::vector<EffectSpec>& model,
                                           const LayerChoice& layers);

// The same in two steps: what is bound, also of layers that the wear of the chosen ones takes, and
// what wear leaves of the chosen ones.
std::vector<Shared<RunLayer>> bound_layers(const MeasuredJob& job, const PrinterModel& printer,
                                           const LayerChoice& layers);
std::vector<Shared<RunLayer>> worn_layers(const MeasuredJob& job, const PrinterModel& printer,
                                          const std::vector<Shared<RunLayer>>& bound,
                                          const LayerChoice& layers);

// At most about `max_points` edges, picked evenly by a hash of their place, so that the same job
// gives the same points. Edges without a measured partner within `reach_mm` are left out.
std::vector<SurfacePoint> surface_points(const MeasuredJob& job,
                                         const std::vector<EffectSpec>& model,
                                         const LayerChoice& layers, int max_points,
                                         double reach_mm);

// Dose minus level of a model at each point's model edge, moved by `offset_vx` of (x, y) voxels.
std::vector<double> margins_at(const MeasuredJob& job, const std::vector<EffectSpec>& model,
                               const std::vector<SurfacePoint>& points,
                               std::array<double, 2> offset_vx = {0, 0});

}  // namespace binderjet
