// SPDX-License-Identifier: GPL-3.0-or-later
// Where a measured job stands and how high it is: what a kind of effect needs to know of the job in
// order to say what to look for in it.
#pragma once

#include <array>

#include "slicer/layers/grid.h"

namespace binderjet {

struct JobExtent {
  Grid grid{};
  JobPlace place{};
  int first_layer = 0;  // the number of the lowest layer that was measured
  int layers = 0;

  double layer_mm(int layer) const { return layer * grid.pitch_mm[2]; }
  std::array<double, 2> center_mm() const { return {place.center_mm(0), place.center_mm(1)}; }
};

}  // namespace binderjet
