// SPDX-License-Identifier: GPL-3.0-or-later
// The printer model: the ordered effects of a profile as one function from masks to printed voxels.
#pragma once

#include <array>
#include <cstdint>
#include <variant>
#include <vector>

#include "slicer/layers/grid.h"
#include "slicer/layers/run_layer.h"
#include "slicer/layers/window.h"
#include "slicer/model/effects/assembled_model.h"
#include "slicer/model/effects/effect.h"

namespace binderjet {

class PrinterModel {
 public:
  // Error{kBadInput} if the effects are no whole model (nothing binds, or binds twice). `place` is
  // where the job stands; a model that does not ask for it prints the same anywhere.
  PrinterModel(const std::vector<EffectSpec>& effects, const Grid& grid,
               const JobPlace& place = {});
  PrinterModel(AssembledModel form, const Grid& grid, const JobPlace& place = {});

  const AssembledModel& form() const { return form_; }
  const Reach& reach() const { return reach_; }
  // How many layers on each side of a mask print() wants to see.
  int window_reach() const { return std::max(reach_.layers_below, reach_.layers_above); }

  // The printed voxels of a layer, at the voxel grid in x and y; all its rz slices are equal.
  // `window` holds its mask and those of window_reach() layers on each side; null is powder.
  // `layer` is the layer's number in its job, from 0 on the bed.
  RunLayer print(const RunWindow& window, int layer = 0) const;
  // The same for a layer between layers of powder.
  RunLayer print(const RunLayer& mask) const;

  // print() in two steps, so that who wants all layers need not bind each of them many times:
  // what is bound, from a window of bind_reach() layers on each side ...
  int bind_reach() const { return window_reach() - wear_reach(); }
  RunLayer bind(const RunWindow& window, int layer) const;
  // ... and what is left of that, from wear_reach() bound layers on each side.
  int wear_reach() const;
  RunLayer worn(const RunWindow& bound) const;

 private:
  // Most models are one box (the paper's is), which has a faster way.
  struct OneBox {
    BoxWeights x;
    BoxWeights y;
    std::int64_t least;
  };
  void choose_filter(const Grid& grid, const JobPlace& place);

  std::array<int, 2> repeat_;
  AssembledModel form_;
  Reach reach_;
  std::variant<OneBox, DoseFilter> filter_;
};

}  // namespace binderjet
