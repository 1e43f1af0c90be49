// SPDX-License-Identifier: GPL-3.0-or-later
// Where a model's print differs from the measured ones, counted in cells of the job.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "slicer/calibrate/residual/surface.h"

namespace binderjet {

// Slabs along each axis that folds and nulls are made of.
constexpr int kSlabs = 5;
constexpr int kCells = kSlabs * kSlabs * kSlabs;

// Which of the job's slabs a place is in, and which cell; places in voxels and layers.
int slab_of(int at, int count);
int cell_of(int slab_x, int slab_y, int slab_z);
// The slab of a cell along an axis (0: x, 1: y, 2: z).
int slab_of_cell(int cell, int axis);

// Wrong voxels in each of kSlabs x kSlabs columns of a layer, summed over the replicates.
using ColumnCounts = std::array<std::int64_t, std::size_t{kSlabs} * kSlabs>;
// Per layer of the job; what was not looked at is 0.
using WrongCounts = std::vector<ColumnCounts>;

// `printed` as print_layers() gives it: layers without a print are not looked at.
WrongCounts wrong_counts(const MeasuredJob& job, const std::vector<Shared<RunLayer>>& printed);
// One measured layer against a print of it.
ColumnCounts wrong_in_layer(const MeasuredJob& job, int layer, const RunLayer& printed);

std::int64_t sum_of(const WrongCounts& counts);
// Per cell, how many voxels fewer are wrong in `after` than in `before`.
std::vector<double> gains(const WrongCounts& before, const WrongCounts& after);

// |printed xor measured| / |measured| over the chosen layers, mean of the replicates.
double wrong_share(const MeasuredJob& job, const EffectList& model, const LayerChoice& layers);

}  // namespace binderjet
