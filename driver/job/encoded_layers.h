// SPDX-License-Identifier: GPL-3.0-or-later
// A job's layers as the records that a job file or a printer takes: masks, and color beside them.
#pragma once

#include <memory>

#include "driver/job/estimate.h"
#include "driver/job/job.h"
#include "slicer/color/color.h"

namespace binderjet {

// The records of these layers, as they are asked for.
std::unique_ptr<Stream<EncodedLayer>> encoded_layers(const JobHeader& header,
                                                     std::shared_ptr<const Mesh> mesh,
                                                     std::shared_ptr<const ColorField> color,
                                                     LayerRange layers);

}  // namespace binderjet
