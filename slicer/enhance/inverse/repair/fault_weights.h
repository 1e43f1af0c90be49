// SPDX-License-Identifier: GPL-3.0-or-later
// What a fault weighs against wrong voxels, in voxels: a piece that comes off is seen as one by up
// to three layers and spoils a part; a feature that is gone spoils itself.
#pragma once

#include <cstdint>

namespace binderjet {

constexpr std::int64_t kPieceWeight = 1000;
constexpr std::int64_t kFeatureWeight = 500;

}  // namespace binderjet
