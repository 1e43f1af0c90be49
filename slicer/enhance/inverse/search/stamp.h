// SPDX-License-Identifier: GPL-3.0-or-later
// The printer model as the inverse solver sees it: what one mask pixel adds to the dose.
//
//   dose of a layer = sum over the pixels that are on of the pixel's stamp, laid where it lands
//
// A stamp is the kernels of all terms from one layer, summed over the voxels of a pixel, in whole
// units. So a flip costs the area of a stamp, and after any number of flips the dose is the same as
// if it were computed anew.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "slicer/layers/grid.h"
#include "slicer/model/printer_model.h"

namespace binderjet {

// What a pixel of layer k + layer adds to the dose of layer k, wherever on the bed it lies.
struct Stamp {
  int layer = 0;
  std::array<int, 2> first{};  // its lower corner from the pixel's first voxel
  int width = 0;               // whole vectors: the last columns may be 0
  int height = 0;
  std::vector<int> dose;  // row-major
  double total = 0;       // all of it
};

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
  std::vector<Stamp> stamps;  // one per layer that matters, of a pixel that is not shifted
  std::vector<DoseLevel> levels;
  int unit = 0;  // a dose of 1, in the unit of stamps and levels
};

// Columns of a stamp that are worked on at once are whole vectors.
constexpr int kStampVector = 8;
constexpr int whole_vectors(int columns) {
  return (columns + kStampVector - 1) / kStampVector * kStampVector;
}

// weights[i] is how much a wrong voxel counts under models[i]. The unit is 2^-29 or, where binder
// adds up to more than 1, coarser. Stamps are rounded to units, so a dose that misses a level by no
// more than that rounding counts as bound; the exact model (PrinterModel) has the last word.
std::vector<StampedModel> stamped(std::span<const PrinterModel> models,
                                  std::span<const int> weights, const Grid& grid);

}  // namespace binderjet
