// SPDX-License-Identifier: GPL-3.0-or-later
// Powder that cannot be blown out: pockets of the print that no path leads out of, by faces.
#pragma once

#include <vector>

#include "slicer/layers/regions.h"
#include "slicer/layers/run_layer.h"

namespace binderjet {

class TrappedPowder {
 public:
  // The next printed layer up, from the lowest. Returns the pockets that end below it; their z is
  // in layers from 0. What is still open with the last layer is open above, as is the lowest below.
  std::vector<Region> add(const RunLayer& printed);

 private:
  RegionFinder powder_;
  bool first_ = true;
};

}  // namespace binderjet
