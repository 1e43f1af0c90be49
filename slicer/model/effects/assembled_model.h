// SPDX-License-Identifier: GPL-3.0-or-later
// What the effects of a model add up to: each effect writes its forward form into it.
#pragma once

#include <array>
#include <functional>
#include <memory>
#include <vector>

#include "slicer/layers/grid.h"
#include "slicer/layers/run_layer.h"
#include "slicer/layers/window.h"
#include "slicer/model/dose/bed_dependence.h"
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
  std::function<RunLayer(const RunWindow&)> apply;
  // What this wear leaves ends where it ended before, so that a surface still tells the dose there.
  bool keeps_edges = false;
};

// What the effects of a model add up to. Each effect's forward form writes its share into it, so
// simulate, enhance and calibrate know this form and no effect by name.
struct AssembledModel {
  // The dose is the sum of these. Before any effect a pixel's binder stays in its pixel.
  std::vector<DoseTerm> terms{DoseTerm{}};
  double level = 0;  // a voxel is bound iff its dose is at least this; 0: no effect has said so
  std::vector<Wear> wear;  // in the order in which the part suffers it
  std::vector<LayerMove> moves;
  // What depends on the place on the bed, in mm; `place` is where the job is on it.
  BedDependence placed;
  JobPlace place;

  // Shifts every mask by by_mm(spot); neither component is ever larger than that of `max_mm`.
  void shift(std::function<std::array<double, 2>(const Spot&)> by_mm,
             const std::array<double, 2>& max_mm);
  // Adds wear that comes before all that moves edges, whatever the order of the effects.
  void wear_first(Wear step);
  // Asks for Spot::density; Error{kBadInput} if another effect asks for another radius.
  void ask_density(double radius_mm);
  // Declares the level; Error{kBadInput} if another effect already has.
  void bind_at(double new_level);
  Reach reach(const Grid& grid) const;

  // The masks that layers around layer `layer` really get. Those whose mask is beyond the window
  // get null; if the middle one is, it gets `powder`.
  struct Received {
    RunWindow masks;
    std::shared_ptr<const RunLayer> powder;
  };
  Received received(const RunWindow& window, int layer) const;
};

// What these effects add up to for a job that stands at `place`. Error{kBadInput} from the effects.
AssembledModel assemble(const EffectList& effects, const Grid& grid, const JobPlace& place);

}  // namespace binderjet
