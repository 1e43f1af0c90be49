// SPDX-License-Identifier: GPL-3.0-or-later
// The colors in which every picture shows a print against what it should be.
#pragma once

#include "slicer/stack/indexed_png.h"

namespace binderjet {

inline constexpr Rgb kPowderColor{255, 255, 255};
inline constexpr Rgb kCorrectColor{190, 190, 190};
inline constexpr Rgb kMissingColor{255, 120, 110};
inline constexpr Rgb kExtraColor{120, 160, 255};

}  // namespace binderjet
