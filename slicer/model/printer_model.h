// SPDX-License-Identifier: GPL-3.0-or-later
// The printer model: the ordered effects of a profile as one function from masks to printed voxels.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <variant>
#include <vector>

#include "slicer/layers/grid.h"
#include "slicer/layers/run_layer.h"
#include "slicer/layers/stream.h"
#include "slicer/model/dose/dose_filter.h"
#include "slicer/model/effects/effect.h"

namespace binderjet {

// Layer k gets the mask of layer k + by(k), |by| <= most, both in layers of the job.
struct LayerMove {
  std::function<int(int)> by;
  int most;
};

// What happens to printed voxels once they are bound: a layer from the printed layers around it,
// as many below as above; null is beyond the job.
struct Wear {
  Reach reach;
  std::function<RunLayer(std::span<const RunLayer* const>)> apply;
};

// What the effects of a model add up to. Each effect's forward form writes its share into it, so
// simulate, enhance and calibrate know this form and no effect by name.
struct ModelForm {
  // The dose is the sum of these. Before any effect a pixel's binder stays in its pixel.
  std::vector<DoseTerm> terms{DoseTerm{}};
  double level = 0;  // a voxel is bound iff its dose is at least this; 0: no effect has said so
  // Bound powder that holds no such box (voxels in x and y) is brushed off.
  std::vector<std::array<int, 2>> survive_vx;
  // In their order, after that.
  std::vector<Wear> wear;
  std::vector<LayerMove> moves;
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

  // The masks that layers around layer `layer` really get. Those whose mask is beyond the window
  // get null; if the middle one is, it gets `powder`.
  struct Received {
    std::vector<const RunLayer*> masks;
    std::shared_ptr<const RunLayer> powder;
  };
  Received received(std::span<const RunLayer* const> window, int layer) const;
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

  // print() in two steps, so that who wants all layers need not bind each of them many times:
  // what is bound, from the middle bind_reach() layers of such a window ...
  int bind_reach() const { return window_reach() - wear_reach(); }
  RunLayer bind(std::span<const RunLayer* const> window, int layer) const;
  // ... and what is left of that, from wear_reach() bound layers below, its own, and as many above.
  int wear_reach() const;
  RunLayer worn(std::span<const RunLayer* const> bound) const;

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
  std::variant<OneBox, DoseFilter> filter_;
};

}  // namespace binderjet
