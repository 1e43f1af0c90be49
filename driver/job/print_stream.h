// SPDX-License-Identifier: GPL-3.0-or-later
// What the printer model makes of masks, streamed, and written as a slice stack.
#pragma once

#include <memory>
#include <string>

#include "driver/base/console.h"
#include "driver/job/mask_source.h"
#include "slicer/model/printer_model.h"

namespace binderjet {

// The printed voxels of each mask; layers that the source lacks are powder. Source and model must
// outlive the stream.
std::unique_ptr<Stream<RunLayer>> printed_stream(const MaskSource& masks,
                                                 const PrinterModel& model);

// Writes them to `folder`, at the voxel pitch in x and y and one image per layer.
void write_printed(const MaskSource& masks, const PrinterModel& model, const Grid& grid,
                   const std::string& folder, const Console& console);

}  // namespace binderjet
