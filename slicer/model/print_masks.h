// SPDX-License-Identifier: GPL-3.0-or-later
// Printing as a step of a pipeline: from the masks of a job, or of the piece of it that is there,
// to the printed voxels of each layer.
#pragma once

#include <memory>

#include "slicer/layers/pipeline.h"
#include "slicer/model/printer_model.h"

namespace binderjet {

// A window of whole masks as the printer model takes it.
inline RunWindow masks_of(const Window<RunLayer>& masks) {
  return runs_around(masks, masks.reach().below, [](const RunLayer& mask) { return &mask; });
}

inline Pipeline<RunLayer> print_masks(const Pipeline<RunLayer>& masks,
                                      std::shared_ptr<const PrinterModel> model) {
  const LayerReach reach = LayerReach::both_sides(model->window_reach());
  return masks.then("print", reach,
                    [model = std::move(model)](int layer, const Window<RunLayer>& window) {
                      return model->print(masks_of(window), layer);
                    });
}

}  // namespace binderjet
