// SPDX-License-Identifier: GPL-3.0-or-later
// A job's layers as the records that a job file or a printer takes: masks, and color beside them.
#pragma once

#include <memory>

#include "driver/job/estimate.h"
#include "driver/job/job.h"
#include "slicer/color/color.h"
#include "slicer/layers/pipeline.h"

namespace binderjet {

// `color` is null where no part has any; `mesh` is the job's parts as one.
Pipeline<EncodedLayer> encoded_layers(const JobHeader& header, std::shared_ptr<const Mesh> mesh,
                                      std::shared_ptr<const ColorField> color);

}  // namespace binderjet
