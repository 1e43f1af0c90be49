// SPDX-License-Identifier: GPL-3.0-or-later
// Inverse: the mask whose print is nearest to the target, found by search on the printer model.
//
// Lithography's problem (blur, threshold, find the mask) on powder. A layer's mask is searched
// while the masks around it stay (slicer/enhance/inverse/search/mask_search.h); what comes out too
// deep, lost or fused is searched again at a higher price; then the exact model judges it
// (slicer/enhance/inverse/judge.h). A mask that prints any layer worse than the plain masks do is
// dropped.
#pragma once

#include <memory>
#include <vector>

#include "slicer/enhance/inverse/search/inverse_layer.h"
#include "slicer/enhance/inverse/search/search_model.h"
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

  // How many layers on each side of a layer these look at; find_broken() looks at one.
  int improve_reach() const;
  int print_reach() const;
  int repair_reach() const;
  // The layers k and k + stride() print into no common layer. So every stride()-th layer can be
  // improved at once: none of them changes a print that another one judged by.
  int stride() const;
  // Whether improve() gives layers of equal sections equal masks: no effect couples layers or asks
  // for the place on the bed.
  bool sees_the_section_alone() const;
  // Whether gains depend on the masks' density. A search takes the density as it is, so when masks
  // have changed all layers must be improved once more.
  bool follows_density() const;

  // Layer `number` of the job with its plain mask, or what the rules leave of it.
  InverseLayer plain(int number, Shared<VoxelLayer> target) const;
  // The middle layer with a better mask, or the same.
  InverseLayer improve(const LayerWindow& layers) const;
  // The middle layer with what the masks so far print there, and with what is broken in the print;
  // for the latter all layers must have been printed.
  InverseLayer print(const LayerWindow& layers) const;
  InverseLayer find_broken(const LayerWindow& layers) const;
  // The middle layer, searched again around what is lost, fused, spurious or loose in this layer
  // and the ones beside, with their masks as they are; all must have been judged. What is broken
  // never grows, as long as no two layers are repaired at once that are less than repair_stride()
  // apart.
  InverseLayer repair(const LayerWindow& layers) const;
  int repair_stride() const { return stride() + 2; }
  // Of pixel (x, y) of the middle layer, its mask so far.
  PixelReasons reasons(const LayerWindow& layers, int x, int y) const;

 private:
  std::vector<PrinterModel> window_;
  SearchModel search_;
};

}  // namespace binderjet
