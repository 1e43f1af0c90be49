// SPDX-License-Identifier: GPL-3.0-or-later
// A job's masks from its parts: the way of making them that its header names, and then, whatever
// the way, its printer's mask rules.
#pragma once

#include <memory>

#include "driver/job/job.h"
#include "slicer/enhance/masks.h"

namespace binderjet {

// `mesh` is the job's parts as one.
Pipeline<MaskLayer> job_masks(const JobHeader& header, std::shared_ptr<const Mesh> mesh);

}  // namespace binderjet
