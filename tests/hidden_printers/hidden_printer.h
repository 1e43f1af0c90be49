// SPDX-License-Identifier: GPL-3.0-or-later
// A printer with an effect that nobody declared: dense physics in floating point, written without
// anything of slicer/model/effects, so that a calibration cannot find its own code in the data.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "slicer/calibrate/job/measured_job.h"
#include "slicer/model/effects/covariate.h"
#include "slicer/model/effects/effect.h"

namespace binderjet::hidden {

// x, y, z in mm from the lower corner of the masks, and the layer's number.
struct At {
  double x = 0;
  double y = 0;
  double z = 0;
  int layer = 0;
};

struct Printer {
  std::string name;
  std::string effect;  // the kind of the catalogue whose physics it has; empty: none
  // Any of these words, or any of these axes, names the effect rightly; both empty: there is none.
  std::vector<std::string> kinds;
  std::vector<Covariate::Axis> axes;

  std::array<double, 2> width_mm{0.7, 0.3};
  bool gaussian = false;  // the same second moment, another shape
  double level = 0.5;
  double bleed_down = 0;
  double wick_up = 0;
  double tail_share = 0;
  double tail_mm = 1;  // standard deviation
  double density = 0;  // level - density (share in a ball - 0.5)
  double ball_mm = 2;
  double wear_mm = 0;      // the print blurred in 3-D and cut at a half
  double thinnest_mm = 0;  // what is thinner along x or y, within its layer, breaks off
  double soak_mm = 0;      // glue fills gaps narrower than twice that ...
  double skin_mm = 0;      // ... and every face grows by this
  std::function<double(const At&)> gain;   // of the dose
  std::function<double(const At&)> drops;  // of the binder before it spreads
  // Of a drop at so many mm from where its line along x begins.
  std::function<double(double mm)> drop_of_line;
  std::function<int(int)> layer_of;  // layer k gets the mask of layer layer_of(k); powder beyond
  std::function<std::array<double, 2>(const At&)> shift_mm;
  double noise = 0.02;     // of the dose, standard deviation
  double noise_mm = 0.05;  // its correlation
};

// What the maker of a Printer declares, who knows of its spread and its level alone.
std::vector<EffectSpec> declared();

// A dense stack of masks; layers are of grid.pitch_mm.
using Solid = std::function<bool(double x, double y, double z)>;

// A test part: slots and walls along x and y, steps up and down, a pocket, wedges and a round hole.
MeasuredJob part(const std::string& name, std::array<double, 3> size_mm, int variant);

// Adds a print of the job by this printer; the same seed gives the same print. Seed 0 has no noise.
void print(const Printer& printer, MeasuredJob& job, unsigned seed);

// The printers of the trials: every effect of the catalogue at a strength, some without a name,
// pairs.
std::vector<Printer> catalogue(double strength);
std::vector<Printer> nameless();
std::vector<Printer> pairs();

}  // namespace binderjet::hidden
