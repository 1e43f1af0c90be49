// SPDX-License-Identifier: GPL-3.0-or-later
// Layers of runs as few bytes, for a page that unpacks them in a browser (viewer.js).
#pragma once

#include <string>

#include "slicer/layers/run_layer.h"

namespace binderjet {

// Appends `layer` as changes to `reference`, which has rows of the same number; a stream of LEB128
// varints, row by row: 0 if the row has as many flips as the reference's, then for each the zigzag
// difference from the reference's flip; else the number of flips + 1, then for each its distance
// from the one before (the first from 0).
void encode_runs(const RunLayer& layer, const RunLayer& reference, std::string& out);

}  // namespace binderjet
