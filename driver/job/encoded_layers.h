// SPDX-License-Identifier: GPL-3.0-or-later
// A job's layers as the records that a job file or a printer takes: masks, and color beside them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "driver/job/job.h"
#include "slicer/base/work.h"
#include "slicer/color/color.h"
#include "slicer/enhance/rules/mask_rules.h"
#include "slicer/layers/pipeline.h"

namespace binderjet {

struct EncodedLayer {
  std::vector<std::byte> record;  // of its mask, and of its color behind that
  std::int64_t mask_px = 0;       // pixels of binder
  std::int64_t target_vx = 0;     // solid voxels of the target
  RuleChanges rule_changes;
};

// `color` is null where no part has any; `mesh` is the job's parts as one.
Pipeline<EncodedLayer> encoded_layers(const JobHeader& header, std::shared_ptr<const Mesh> mesh,
                                      std::shared_ptr<const ColorField> color,
                                      const Work& work = {});

}  // namespace binderjet
