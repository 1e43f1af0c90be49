// SPDX-License-Identifier: GPL-3.0-or-later
// A job as one HTML page that needs no other file and no network: all layers, side by side.
//
// Layers lie in chunks of kChunkLayers, each a <script type="text/plain" id="chunkN"> of base64 of
// zlib of varints (run_codec.h): for each layer the target's rz slices, each as changes to the one
// before; the plain mask to the last layer's; the mask to the plain one; the print to the highest
// slice. Without a target: the mask and the print, each to the last layer's. The first layer of a
// chunk refers to powder. Color is a PNG for each layer, id="colorN", N from 0.
#pragma once

#include <string>

#include "driver/base/console.h"
#include "driver/job/mask_source.h"

namespace binderjet {

constexpr int kChunkLayers = 8;

// The page of a job. The target is made from the job's models; if they are gone the page goes
// without, and a warning says so.
std::string viewer_page(const MaskSource& job, const Console& console);

}  // namespace binderjet
