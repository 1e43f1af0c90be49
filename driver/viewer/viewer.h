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
//   and enhanced       the plain mask's print     to the layer's highest slice
//   without a target   the mask, and the print    to the same of the layer below
//
// For the first layer of a chunk the layer below is powder, so a chunk can be read by itself. Color
// is a PNG for each layer, id="colorN", N from 0.
//
// With a target there is also id="places": what to look at first (Findings::to_look_at()), as JSON.
#pragma once

#include <memory>
#include <string>

#include "driver/job/mask_source.h"
#include "slicer/base/work.h"
#include "slicer/mesh/mesh.h"

namespace binderjet {

constexpr int kChunkLayers = 8;

// The page of a job. `mesh` is its models as one (reload_parts()); null if they are gone, and then
// the page goes without the target.
std::string viewer_page(const MaskSource& job, const std::shared_ptr<const Mesh>& mesh,
                        const Work& work);

}  // namespace binderjet
