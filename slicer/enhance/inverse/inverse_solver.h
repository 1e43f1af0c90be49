// SPDX-License-Identifier: GPL-3.0-or-later
// Inverse: the mask whose print is nearest to the target, found by search on the printer model.
//
//   cost(mask) = sum over models m of weight_m * sum over voxels of (wrong slices under m)
//   weight     = 2 for the nominal model, 1 for each corner of the process window
//
// Lithography's problem (blur, threshold, find the mask) on powder. A layer's mask is improved
// while the masks around it stay: it begins where a straight edge would have to be, then single
// pixels flip as long as the cost falls. The corners count so that a mask is also right on a
// printer that is a little off. A mask that prints any layer worse than the plain masks do is
// dropped.
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

// Why a pixel is on or off: the print as it is, and the print if the pixel were in the other state.
struct PixelReasons {
  bool on = false;
  double target_share = 0;           // share of the pixel's voxels (all slices) that are target
  double level = 0;                  // the dose from which on powder binds
  std::vector<double> dose;          // of the pixel's voxels as it is, row by row
  std::vector<double> dose_flipped;  // of the same voxels with the pixel in the other state
  int nominal_cost = 0;              // wrong voxels of the nominal model that the flip would add
  int window_cost = 0;               // the same, weighted over the process window
  bool rules_allow = true;           // whether the mask rules allow the flip
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
  // The layers k and k + stride() print into no common layer. So every stride()-th layer can be
  // improved at once: none of them changes a print that another one judged by.
  int stride() const { return stride_; }
  // Whether gains depend on the masks' density. A search takes the density as it is, so when masks
  // have changed all layers must be improved once more.
  bool follows_density() const {
    return search_.printer.form().placed.density_radius_mm.has_value();
  }

  // The model and the rules that the search goes by, for the repair of many layers
  // (slicer/enhance/inverse/repair/mend.h).
  const SearchModel& by() const { return search_; }

  // Layer `number` of the job with its plain mask, or what the rules leave of it.
  InverseLayer plain(int number, Shared<VoxelLayer> target) const;
  // The middle layer with a better mask. With `from_scratch` its mask so far is forgotten. The mask
  // is kept as it was if the new one gives any layer more wrong voxels (nominal model) than the
  // plain masks do and than it has now.
  InverseLayer improve(LayerWindow layers, bool from_scratch) const;
  // The same with fewer faults that voxels alone do not show
  // (slicer/enhance/inverse/repair/rescue.h), if it has any.
  InverseLayer rescue(LayerWindow layers, RescueAim aim) const;
  // The middle layer after spurious print was taken back to the plain mask, further and further
  // around it; the plain mask altogether if the layer then prints worse than plain.
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
