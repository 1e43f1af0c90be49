// SPDX-License-Identifier: GPL-3.0-or-later
// A job as one HTML page that needs no other file and no network: all layers, side by side.
//
// Layers lie in chunks of kChunkLayers, each a <script type="text/plain" id="chunkN"> of base64 of
// zlib of varints (run_codec.h). A layer is some pictures, each as changes to another one:
//
//   with a target      each of its rz slices      to the slice below
//                      the plain mask             to the plain mask of the layer below
//                      the mask                   to the plain mask
//                      the print                  to the layer's highest slice
//   without a target   the mask, and the print    to the same of the layer below
//
// For the first layer of a chunk the layer below is powder, so a chunk can be read by itself. Color
// is a PNG for each layer, id="colorN", N from 0.
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
