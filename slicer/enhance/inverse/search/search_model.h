// SPDX-License-Identifier: GPL-3.0-or-later
// All that a search knows beside the layers: the printer model, exact and as stamps.
#pragma once

#include <span>
#include <vector>

#include "slicer/enhance/inverse/search/inverse_layer.h"
#include "slicer/enhance/rules/mask_rules.h"
#include "slicer/layers/grid.h"
#include "slicer/model/printer_model.h"

namespace binderjet {

// What a wrong voxel of the printer as it is weighs, of a corner of the process window that moves a
// straight edge farther than the mean of all corners, and of any other. It is the worst corner that
// counts, and that is one of the former: with 1 for all, the worst case of smooth parts is up to a
// tenth worse; with 20 for the printer the excess falls by a tenth, and the worst case grows by as
// much.
constexpr int kNominalWeight = 8;
constexpr int kFarCornerWeight = 2;

// Of each model of the window, the printer first.
std::vector<int> window_weights(std::span<const PrinterModel> window, const Grid& grid);

// A level at which the dose binds powder, and how much a wrong voxel counts there.
struct DoseLevel {
  int least = 0;
  int weight = 1;
};

// Models of the process window whose terms are equal: one dose, compared with the level of each.
//
// Models with gains share nothing. A voxel with dose d and gain g is bound iff g d >= level, that
// is iff d + credit >= level with credit = level - level / g. So each level has credits of its own,
// which are added to the dose once.
struct StampedModel {
  std::vector<DoseTerm> terms;
  std::vector<DoseLevel> levels;
};

struct SearchModel {
  // The first of `window` is the printer, the others are what it may drift to.
  SearchModel(std::span<const PrinterModel> window, const MaskRules& its_rules,
              const Grid& its_grid);

  PrinterModel printer;              // exact: it judges
  std::vector<StampedModel> models;  // of the window, the printer first
  int unit;                          // a dose of 1; doses of all models fit 16 bits
  ModelOffsets offsets;
  MaskRules rules;
  Grid grid;
};

}  // namespace binderjet
