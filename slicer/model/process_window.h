// SPDX-License-Identifier: GPL-3.0-or-later
// The process window: a printer's model and how far a real printer may be off it.
#pragma once

#include <vector>

#include "slicer/model/printer_model.h"

namespace binderjet {

// The model itself, then the corners of its window: each parameter that drifts (NumberRule) at its
// least and its most, those of one effect together. An effect's corners stand beside those of the
// others, so spread and threshold give 1 + 2 x 2 models.
std::vector<PrinterModel> process_window(const std::vector<EffectSpec>& effects, const Grid& grid,
                                         const JobPlace& place = {});

}  // namespace binderjet
