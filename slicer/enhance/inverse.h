// SPDX-License-Identifier: GPL-3.0-or-later
// Inverse: the mask whose print is nearest to the target, found by search on the printer model.
//
// Lithography's problem (blur, threshold, find the mask) on powder. A layer's mask is improved
// while the masks around it stay: it begins where a straight edge would have to be, then single
// pixels flip as long as fewer voxels come out wrong. What counts is the mean over the process
// window, the nominal model most, so that a mask is also right on a printer that is a little off. A
// mask that prints any layer worse than the plain masks do is dropped.
#pragma once

#include <array>
#include <memory>
#include <span>
#include <vector>

#include "slicer/effects/model.h"
#include "slicer/enhance/mask_rules.h"
#include "slicer/enhance/stamp.h"
#include "slicer/grid.h"
#include "slicer/run_layer.h"
#include "slicer/stream.h"
#include "slicer/voxelize.h"

namespace binderjet {

// A layer on its way: shared, for most steps change one of its parts only.
struct InverseLayer {
  Shared<VoxelLayer> target;
  Shared<RunLayer> plain;  // its mask without enhancement
  Shared<RunLayer> mask;   // its mask so far; obeys the rules
};

class InverseSolver {
 public:
  // The first model is the printer, the others are what it may drift to (process_window()); with
  // one model only that counts.
  InverseSolver(std::vector<PrinterModel> window, const Grid& grid, const MaskRules& rules);

  // How many layers on each side of a layer improve() looks at.
  int reach() const { return 2 * models_.front().window_reach(); }
  // Layers so many apart (or a multiple) print into no common layer, so all of them may be improved
  // at once and none spoils what another one saw.
  int stride() const { return stride_; }

  InverseLayer plain(Shared<VoxelLayer> target) const;
  // The middle one of 2 reach() + 1 layers, null beyond the job's ends; `anew` forgets its mask so
  // far. No layer prints worse than with plain masks, if none did before (nominal model, voxels).
  InverseLayer improve(std::span<const Shared<InverseLayer>> layers, bool anew) const;

 private:
  std::vector<PrinterModel> models_;
  Grid grid_;
  MaskRules rules_;
  std::vector<StampedModel> stamped_;
  int stride_ = 1;
};

}  // namespace binderjet
