// SPDX-License-Identifier: GPL-3.0-or-later
// The printer model's dose at single places, in real numbers: what a fit needs, where a print needs
// whole layers of bits.
#pragma once

#include <span>
#include <vector>

#include "slicer/model/printer_model.h"

namespace binderjet {

// A place within a layer, in voxels from the masks' lower corner: voxel (i, j) has its middle at
// (i, j); halves are between two voxels.
struct DosePlace {
  double x_vx = 0;
  double y_vx = 0;
};

class DoseProbe {
 public:
  DoseProbe(AssembledModel form, const Grid& grid, const JobPlace& place);

  // How many layers on each side of a mask the windows below must hold.
  int window_reach() const { return window_reach_; }

  // Dose minus level at each place of a layer; `window` as for PrinterModel::print().
  void margins(const RunWindow& window, int layer, std::span<const DosePlace> places,
               std::span<double> out) const;

 private:
  // The running sum of a kernel: rise[i] is the share that lands at most at first + i.
  struct Rise {
    int first = 0;
    std::vector<double> rise;
    double at(double offset) const;
  };
  struct Term {
    int layer;
    double gain;
    Rise x;
    Rise y;
    int y_first;
    int y_last;
  };
  static Rise rise_of(const Kernel& kernel);
  double term_dose(const Term& term, const RunLayer& mask, int layer, DosePlace place) const;

  AssembledModel form_;
  Grid grid_;
  JobPlace place_;
  int window_reach_;
  int max_shift_vx_ = 0;  // along y
  std::vector<Term> terms_;
};

}  // namespace binderjet
