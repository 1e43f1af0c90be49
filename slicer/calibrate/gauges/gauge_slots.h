// SPDX-License-Identifier: GPL-3.0-or-later
// Slots and walls of a printed gauge: which show and how wide they came out, against the model; and
// which single change of the model agrees with them.
//
// One number of the model at a time takes every value of a grid, and each value predicts all
// readings. With u the uncertainty of a reading:
//
//   misfit(value) = sum over readings of ((measured - predicted(value)) / u)^2
//
// A value agrees if every reading is within its u. Level and width explain slots alike and walls
// differently (slicer/MODEL.md, Printer model), so gauges on which two explanations differ are
// listed. Changing two numbers at once was refused: that agrees with almost anything.
#pragma once

#include <string>
#include <vector>

#include "slicer/calibrate/gauges/gauge_strip.h"
#include "slicer/calibrate/gauges/gauge_table.h"
#include "slicer/layers/grid.h"
#include "slicer/model/effects/effect.h"

namespace binderjet {

// What the gauge says about one axis, in mm: the width from which on slots (walls) show, or how
// wide one of them came out.
struct GaugeReading {
  std::string name;  // "first visible slot in x", "wall of 0.5 mm in y"
  GaugeKind kind = GaugeKind::kSlot;
  int axis = 0;
  double nominal_mm = 0;  // of a width; 0 for a first visible one
  double measured_mm = 0;
  double uncertainty_mm = 0;  // above 0
};

// Two forms, by columns:
// clang-format off
//   axis, first_visible_slot_mm_low,     the width from which on an observer saw slots, on a block
//   first_visible_slot_mm_high           with slots 0.1 mm apart (paper, Fig. 3)
//   gauge, axis, nominal_mm, and         gauge is slot or wall; visible is 0 or 1
//   visible or measured_mm, uncertainty_mm
// clang-format on
bool has_slots(const GaugeTable& table);
// Error{kBadInput} with file:line.
std::vector<GaugeReading> read_slots(const GaugeTable& table);

// A change of one number that could explain the readings.
struct Explanation {
  std::string kind;  // GaugeChange::kind
  std::string text;  // "level 0.15 instead of 0.5"
  double value = 0;  // the number that fits best
  double low = 0;    // it may be from here
  double high = 0;   // to here: all readings within their uncertainty, or as near as the best
  std::vector<EffectSpec> effects;   // the model with it
  std::vector<double> predicted_mm;  // per reading
  double rms_mm = 0;                 // of measured - predicted
  // The same where each reading is predicted with the value that fits the others best.
  double heldout_rms_mm = 0;
  bool agrees = false;  // with every reading, within its uncertainty
  int changed_numbers = 0;
};

// A gauge on which two explanations differ, both as the model predicts it.
struct Discriminator {
  std::string gauge;                 // "outer width of 10 mm in x"
  std::vector<double> predicted_mm;  // per explanation; 0: it vanishes or is closed
  double difference_mm = 0;
};

struct SlotFindings {
  std::vector<GaugeReading> readings;
  std::vector<double> declared_mm;  // what the declared model predicts, per reading
  double declared_rms_mm = 0;
  bool declared_agrees = false;
  std::vector<Explanation> explanations;      // that agree, or else the best; best first
  std::vector<Discriminator> discriminators;  // between the first two, largest difference first
};

SlotFindings trace_slots(std::vector<GaugeReading> readings,
                         const std::vector<EffectSpec>& declared, const Grid& grid);

}  // namespace binderjet
