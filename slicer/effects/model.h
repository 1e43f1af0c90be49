// SPDX-License-Identifier: GPL-3.0-or-later
// The printer model: the ordered effects of a profile as one function from masks to printed voxels.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "slicer/dose_filter.h"
#include "slicer/effects/effect.h"
#include "slicer/grid.h"
#include "slicer/run_layer.h"
#include "slicer/stream.h"

namespace binderjet {

// What the effects of a model add up to. Each effect's forward form writes its share into it, so
// simulate, enhance and calibrate know this form and no effect by name.
struct ModelForm {
  // The dose is the sum of these. Before any effect a pixel's binder stays in its pixel.
  std::vector<DoseTerm> terms{DoseTerm{}};
  double level = 0;  // a voxel is bound iff its dose is at least this; 0: no effect has said so
  // Bound powder that holds no such box (voxels in x and y) is brushed off.
  std::vector<std::array<int, 2>> survive_vx;
  // What depends on the place on the bed, in mm; `place` is where the job is on it.
  PlacedDose placed;
  JobPlace place;

  // Shifts every mask by by_mm(spot); neither component is ever larger than that of `most_mm`.
  void shift(std::function<std::array<double, 2>(const Spot&)> by_mm,
             const std::array<double, 2>& most_mm);
  // Asks for Spot::density; Error{kBadInput} if another effect asks for another radius.
  void ask_density(double radius_mm);
  // Declares the level; Error{kBadInput} if another effect already has.
  void bind_at(double new_level);
  Reach reach(const Grid& grid) const;
};

class PrinterModel {
 public:
  // Error{kBadInput} if the effects are no whole model (nothing binds, or binds twice). `place` is
  // where the job stands; a model that does not ask for it prints the same anywhere.
  PrinterModel(const std::vector<EffectSpec>& effects, const Grid& grid,
               const JobPlace& place = {});
  PrinterModel(ModelForm form, const Grid& grid, const JobPlace& place = {});

  const ModelForm& form() const { return form_; }
  const Reach& reach() const { return reach_; }
  // How many layers on each side of a mask print() wants to see.
  int window_reach() const { return std::max(reach_.layers_below, reach_.layers_above); }

  // The printed voxels of a layer, at the voxel grid in x and y; all its rz slices are equal.
  // `window` holds the masks of window_reach() layers below it, its own, and as many above; null
  // is powder. `layer` is the layer's number in its job, from 0 on the bed.
  RunLayer print(std::span<const RunLayer* const> window, int layer = 0) const;
  RunLayer print(std::span<const Shared<RunLayer>> window, int layer = 0) const;
  // The same for a layer between layers of powder.
  RunLayer print(const RunLayer& mask) const;

 private:
  // Most models are one box (the paper's is), which has a faster way.
  struct OneBox {
    BoxWeights x;
    BoxWeights y;
    std::int64_t least;
  };
  void choose_filter(const Grid& grid, const JobPlace& place);

  std::array<int, 2> repeat_;
  ModelForm form_;
  Reach reach_;
  std::optional<OneBox> box_;
  std::optional<DoseFilter> filter_;
};

}  // namespace binderjet
