// SPDX-License-Identifier: GPL-3.0-or-later
// What a printer model makes of one slot or wall that is long and deep, at every place on the grid.
//
// Such a gauge is the same along two axes, so one line of voxels through its middle tells all. How
// many pixels it gets depends on where its edges lie between two of them, so it is printed at 16
// places spread over one pixel.
#pragma once

#include "slicer/layers/grid.h"
#include "slicer/model/printer_model.h"

namespace binderjet {

enum class GaugeKind { kSlot, kWall };

// One width along one axis, over places of the gauge spread evenly over one printer pixel (layer).
struct GaugePrint {
  double mean_mm = 0;        // width of what is open (slot) or stands (wall), over all places
  double visible_share = 0;  // of the places at which at least one voxel is open or stands
};

// Sliced as a part is (voxel centers, then half of a pixel's voxels) and printed by the model, in a
// block of solid (slots) or powder (walls) that reaches further than the binder does. `axis` is 0
// to 2, the normal of the gauge.
GaugePrint print_gauge(const PrinterModel& model, const Grid& grid, GaugeKind kind, int axis,
                       double width_mm);

// The width (mm) from which on the gauge shows at half of all places or more, to 1/64 of a pixel
// (layer) or better; `max_mm` if it shows at none up to there.
double visible_from_mm(const PrinterModel& model, const Grid& grid, GaugeKind kind, int axis,
                       double max_mm);

}  // namespace binderjet
