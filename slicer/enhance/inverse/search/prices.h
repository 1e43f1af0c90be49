// SPDX-License-Identifier: GPL-3.0-or-later
// What a printed voxel costs more than one that is not: the slices of its layer that are powder
// there, less those that are solid. Above 0 powder is wanted, below 0 solid; where as many are
// solid as powder nothing is.
//
// A price that grew with the distance from the surface was tried: all shapes came out worse by a
// third, and too deep they are as seldom (slicer/enhance/inverse/judge.h looks after these).
#pragma once

#include <cstdint>
#include <vector>

#include "slicer/enhance/inverse/search/band.h"
#include "slicer/voxels/voxelize.h"

namespace binderjet {

constexpr int kPriceUnit = 16;  // what a wrong slice costs

// Of the voxels of the band, by number, in 1 / kPriceUnit.
std::vector<std::int16_t> voxel_prices(const VoxelLayer& target, const Band& band);

}  // namespace binderjet
