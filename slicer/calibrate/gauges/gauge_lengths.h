// SPDX-License-Identifier: GPL-3.0-or-later
// Lengths that a caliper read on printed blocks: how parts grow, and what else their error follows.
//
//   error = measured - nominal = growth (offset or scale) + layer slip + place on the bed + rest
//
// The terms are rungs of a ladder (nested_models.h): each has to pay on parts that its fit did not
// see.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "slicer/calibrate/gauges/gauge_table.h"
#include "slicer/calibrate/gauges/nested_models.h"
#include "slicer/model/effects/effect.h"

namespace binderjet {

// Columns by name: nominal_x and meas_x (likewise y, z; mm), at least one axis. Where they are
// there, also: batch, part (its number within the batch), rep (which of the readings of one
// dimension), and pos_x_mm, pos_y_mm (where the part lay on the bed).
bool has_lengths(const GaugeTable& table);

struct LengthRules {
  // A reading that far off is a part that broke or slipped, not one that grew: growth of green
  // parts is below 1.5 mm (literature: 0.2 to 0.6 mm per face). Its row is dropped; a batch with
  // more than half of its rows dropped is dropped whole.
  double drop_mm = 3;
  double min_gain = 0.005;  // of the squared error; a term that brings less is not worth having
};

// A part's growth in a batch told as an offset and as a scale, both held out by part, rms in mm.
struct BatchGrowth {
  std::string batch;
  double offset_rms = 0;
  double scale_rms = 0;
};

struct LengthFindings {
  int rows = 0;  // in the file
  int used_rows = 0;
  std::vector<std::string> dropped;  // what and why, one line each
  std::vector<BatchGrowth> growth;   // of all batches that did not break
  Ladder ladder;
  // Standard deviation of readings of the same dimension of the same part: what no model of the
  // part can explain. 0 if each was read once.
  double floor_rms = 0;
  // The residual's mean over what could be asked of it, before (nominal) and after, held out.
  struct Profile {
    std::string name;
    std::vector<std::string> labels;
    std::vector<double> before_mm, after_mm;
    std::vector<int> readings;
  };
  std::vector<Profile> profiles;

  int offset_batches() const;  // those in which the offset is the better one
};

// What a step of trace_lengths()' ladder says of the printer, for the kinds of effects that would
// cause it (EffectKind::length_causes).
std::optional<LengthTerm> length_term(const Rung& rung);

// Error{kBadInput} with file:line for a number that is none or a nominal length that is not above
// 0, and where too few parts are left to hold any out.
LengthFindings trace_lengths(const GaugeTable& table, const LengthRules& rules);

}  // namespace binderjet
