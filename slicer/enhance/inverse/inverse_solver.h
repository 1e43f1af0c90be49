// SPDX-License-Identifier: GPL-3.0-or-later
// Inverse: the mask whose print is nearest to the target, found by search on the printer model.
//
// Lithography's problem (blur, threshold, find the mask) on powder. A layer's mask is improved
// while the masks around it stay: it begins where a straight edge would have to be, then single
// pixels flip as long as fewer voxels come out wrong. What counts is the mean over the process
// window, the nominal model most, so that a mask is also right on a printer that is a little off. A
// mask that prints any layer worse than the plain masks do is dropped.
#pragma once

#include <memory>
#include <vector>

#include "slicer/enhance/inverse/repair/rescue.h"
#include "slicer/enhance/inverse/search/inverse_layer.h"
#include "slicer/enhance/inverse/search/layer_search.h"
#include "slicer/enhance/rules/mask_rules.h"
#include "slicer/layers/grid.h"
#include "slicer/model/printer_model.h"

namespace binderjet {

// Why a pixel is on or off.
struct PixelReasons {
  bool on = false;
  double target_share = 0;           // of its voxels
  double level = 0;                  // at which powder binds
  std::vector<double> dose;          // of its voxels, row by row
  std::vector<double> dose_flipped;  // the same if the pixel were in the other state
  int nominal_cost = 0;              // how many more voxels were wrong then
  int window_cost = 0;               // and by weight over the process window
  bool rules_allow = true;           // it to be in the other state
};

class InverseSolver {
 public:
  // The first model is the printer, the others are what it may drift to (process_window()); alone,
  // only the first counts.
  InverseSolver(std::vector<PrinterModel> window, const Grid& grid, const MaskRules& rules);

  // How many layers on each side of a layer improve() and rescue() look at.
  int reach() const { return 2 * search_.printer.window_reach() + 1; }
  // The same for settle().
  int print_reach() const { return search_.printer.window_reach(); }
  // Layers so many apart (or a multiple) print into no common layer, so all of them may be improved
  // at once and none spoils what another one saw.
  int stride() const { return stride_; }
  // Whether a layer's print also depends on other layers' masks through their density, which a
  // search takes as it is: then layers are to be improved again.
  bool follows_density() const {
    return search_.printer.form().placed.density_radius_mm.has_value();
  }

  // What it goes by; the mending of many layers (slicer/enhance/inverse/repair/mend.h) wants it
  // too.
  const SearchModel& by() const { return search_; }

  // Layer `number` of the job with its plain mask, or what the rules leave of it.
  InverseLayer plain(int number, Shared<VoxelLayer> target) const;
  // The middle layer with a better mask; `anew` forgets its mask so far. No layer prints worse than
  // with plain masks, unless it did before (nominal model, wrong voxels).
  InverseLayer improve(LayerWindow layers, bool anew) const;
  // The same with fewer faults that voxels alone do not show
  // (slicer/enhance/inverse/repair/rescue.h), if it has any.
  InverseLayer rescue(LayerWindow layers, RescueAim aim) const;
  // The middle layer without what prints where no part is, if anything still does once the others
  // are as they are; with its plain mask again if its print is worse than plain.
  InverseLayer settle(LayerWindow layers) const;
  // Of pixel (x, y) of the middle layer, its mask so far.
  PixelReasons reasons(LayerWindow layers, int x, int y) const;

 private:
  Shared<RunLayer> without_spurious(LayerWindow layers) const;

  std::vector<PrinterModel> window_;
  SearchModel search_;
  int stride_ = 1;
};

}  // namespace binderjet
