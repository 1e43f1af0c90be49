// SPDX-License-Identifier: GPL-3.0-or-later
// Dose and threshold on runs for any sum of separable kernels on a layer and its neighbors.
//
//   D(v) = sum over terms t of g_t * sum over (i, j) of X_t(i) Y_t(j) * mask_(k + l_t)(v - (i, j))
//
// Each flip of a mask adds the running sum of its term's kernel to the dose along its row, so the
// dose's first difference is the kernel, placed at the flip. Between the flips' reaches the dose is
// constant and nothing is computed. All sums are integers: neither order nor threads change them.
//
// Cost: for each row of the result the flips within reach in y, times the width of the kernel. A
// model that is one box has a faster way (box_filter.h). Where the dose has gains, a call is added
// for each voxel that is neither surely bound nor surely free.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "slicer/layers/run_layer.h"
#include "slicer/layers/window.h"
#include "slicer/model/dose/bed_dependence.h"
#include "slicer/model/dose/kernel.h"

namespace binderjet {

// What the dose of layer k gets from the mask of layer k + `layer`: `gain` times the mask (repeated
// to the voxel grid) filtered with x and y, whose weights count as shares of their sums.
struct DoseTerm {
  int layer = 0;
  Kernel x;
  Kernel y;
  double gain = 1;
};

class DoseFilter {
 public:
  // A voxel is 1 iff its dose, the sum of the terms (at least one), is at least `level` (> 0).
  // The first term is exact; gains of the others relative to it are rounded to 2^-20 or, where the
  // sums need the room, a little coarser. Every mask pixel is repeat[0] x repeat[1] voxels.
  DoseFilter(std::span<const DoseTerm> terms, double level, const Grid& grid,
             const BedDependence& placed = {}, const JobPlace& place = {});

  // `window` is the masks around the layer, at least as far as the terms reach; the middle one must
  // be there. Shifted flips are placed to 1/16 voxel.
  RunLayer operator()(const RunWindow& window, int layer = 0) const;

 private:
  // A term as integers; `kernel` is its place in x_.
  struct Term {
    int layer;
    std::size_t kernel;
    Kernel y;
    std::int64_t scale;
  };

  Grid grid_;
  BedDependence placed_;
  JobPlace place_;
  std::array<int, 2> repeat_;
  std::vector<Kernel> x_;  // the different kernels along x
  std::vector<Term> terms_;
  std::int64_t least_;
};

}  // namespace binderjet
