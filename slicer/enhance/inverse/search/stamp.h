// SPDX-License-Identifier: GPL-3.0-or-later
// The printer model as the inverse solver sees it: what one mask pixel adds to the dose.
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

// Models that differ in their levels only share their stamps and so their doses; where the dose has
// gains they do not, for a gain is taken as a credit of dose that depends on the level.
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
// adds up to more than 1, coarser; a dose within rounding of a level counts as bound.
std::vector<StampedModel> stamped(std::span<const PrinterModel> models,
                                  std::span<const int> weights, const Grid& grid);

}  // namespace binderjet
