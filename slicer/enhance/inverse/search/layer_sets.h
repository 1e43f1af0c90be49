// SPDX-License-Identifier: GPL-3.0-or-later
// Layers of one size combined like sets.
#pragma once

#include <span>

#include "slicer/enhance/rules/rect_cells.h"
#include "slicer/layers/run_layer.h"

namespace binderjet {

RunLayer common(const RunLayer& a, const RunLayer& b);
RunLayer either(const RunLayer& a, const RunLayer& b);
RunLayer without(const RunLayer& a, const RunLayer& b);
// What lies in any of the boxes.
RunLayer within(const RunLayer& layer, std::span<const Rect> boxes);

}  // namespace binderjet
