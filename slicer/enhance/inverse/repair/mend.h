// SPDX-License-Identifier: GPL-3.0-or-later
// Mending: what no single layer's mask could set right, over many layers at once.
//
// Around a fault (lost, fused, spurious or loose) the masks of all its layers take pixels from
// simpler ones (the plain masks, those of a layer beside them), from near to far, as long as that
// leaves less such faults and no layer prints worse than with plain masks.
#pragma once

#include "slicer/enhance/inverse/repair/stretch.h"
#include "slicer/enhance/inverse/search/layer_search.h"
#include "slicer/layers/stream.h"

namespace binderjet {

// The layers `own` of a stretch of the job, counted from its first, with fewer faults; the others
// stay.
Stretch::Layers mended(const SearchModel& by, Stretch::Layers layers, LayerRange own,
                       int job_layers);

}  // namespace binderjet
