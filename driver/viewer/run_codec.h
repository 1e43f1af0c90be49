// SPDX-License-Identifier: GPL-3.0-or-later
// Layers of runs as few bytes, for a page that unpacks them in a browser (viewer.js).
#pragma once

#include <string>

#include "slicer/layers/run_layer.h"

namespace binderjet {

// Appends `layer` as changes to `reference`, a layer of the same height. The result is a stream of
// LEB128 varints, row by row, in one of two forms:
//
//   as many flips as the reference    0, then for each flip zigzag(flip - the reference's flip)
//   else, with n flips                n + 1, then for each flip its distance from the one before
//                                     it, the first from 0
//
// zigzag(d) = d < 0 ? -2 d - 1 : 2 d, so small differences of either sign are one byte.
void encode_runs(const RunLayer& layer, const RunLayer& reference, std::string& out);

}  // namespace binderjet
