// SPDX-License-Identifier: GPL-3.0-or-later
// What the printer model makes of masks, streamed, and written as a slice stack.
#pragma once

#include <memory>
#include <string>

#include "driver/console.h"
#include "driver/mask_source.h"
#include "slicer/effects/model.h"

namespace binderjet {

// The printed voxels of each mask; layers that the source lacks are powder. Source and model must
// outlive the stream.
std::unique_ptr<Stream<RunLayer>> printed_stream(const MaskSource& masks,
                                                 const PrinterModel& model);

// Writes them to `folder`, at the voxel pitch in x and y and one image per layer.
void write_printed(const MaskSource& masks, const PrinterModel& model, const Grid& grid,
                   const std::string& folder, const Console& console);

}  // namespace binderjet
