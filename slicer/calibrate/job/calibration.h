// SPDX-License-Identifier: GPL-3.0-or-later
// What a calibration finds: the residual of a declared model traced to effects that it lacks
// (DESIGN section 10), as plain data for calibration.json, the new profile and the report.
#pragma once

#include <array>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "slicer/layers/grid.h"
#include "slicer/layers/run_layer.h"
#include "slicer/layers/stream.h"
#include "slicer/model/effects/effect.h"

namespace binderjet {

// A print that was measured: the masks that were sent and what came out, once per replicate.
struct MeasuredJob {
  std::string name;  // for messages and the report
  Grid grid;
  JobPlace place;
  int first_layer = 0;                  // the number of masks[0]
  std::vector<Shared<RunLayer>> masks;  // at the printer grid
  // Each replicate has one layer per mask, at the voxel grid in x and y, registered to the masks.
  std::vector<std::vector<Shared<RunLayer>>> prints;
  // The prints come from a scanner: they may still be a little shifted, turned and blurred.
  bool scanned = false;
  // Called many times a second during long work, from any of its threads; may throw to end it.
  std::function<void()> on_check;

  void check() const {
    if (on_check) on_check();
  }
  int layers() const { return static_cast<int>(masks.size()); }
};

// What the residual depends on (DESIGN section 10).
struct Covariate {
  std::string axis;  // x, y, z, layer, direction, density, facing, edge_distance, position
  std::string form;  // trend, periodic, step, window, local; empty: constant
  std::map<std::string, std::vector<double>> numbers;  // direction_deg, period_mm, at_mm, ...

  bool operator==(const Covariate&) const = default;
};

struct FoundEffect {
  std::string kind;  // a word of the effect catalogue, or "empirical"
  std::map<std::string, std::vector<double>> parameters;
  Covariate covariate;
  std::vector<std::string> rivals;  // kinds that this print cannot tell from it
  double p = 1;                     // family-wise: over all candidates that were tried
  double heldout_gain = 0;          // share of the residual's power gone where the fit did not look
};

// How far one set of layers is from another: |a xor b| / |b|, and edges in mm.
struct PrintError {
  double wrong = 0;
  double mean_mm = 0;
  double p95_mm = 0;
  double max_mm = 0;
};

// The same data predicted by both models; the fit saw none of it.
struct BeforeAfter {
  std::string name;  // "held-out layers", or the second print
  PrintError before;
  PrintError after;
  std::optional<PrintError> floor;  // one replicate against another, if there are two
};

// The residual along one coordinate, in mm that the surface lies further out than predicted.
struct ResidualProfile {
  std::string name;               // "x", "y", "layer", "edge distance", ...
  std::string unit;               // "mm", "", "deg"
  std::vector<double> centers;    // of bins, ascending
  std::vector<double> before_mm;  // means; as many as centers
  std::vector<double> after_mm;
  std::vector<std::int64_t> points;  // how many surface points are in each bin
};

// The residual that is left: what it depends on most, and how much of its power that is.
struct Remaining {
  Covariate covariate;
  double share = 0;
};

struct Calibration {
  std::string verdict;  // "effect", "none" or "unexplained"
  std::vector<FoundEffect> effects;
  std::optional<Remaining> remaining;
  std::vector<BeforeAfter> scores;  // the first is what `before` and `after` of the JSON say
  std::vector<ResidualProfile> profiles;
  std::vector<EffectSpec> before_model;  // as declared
  std::vector<EffectSpec> after_model;   // refitted, with the effects found
};

}  // namespace binderjet
