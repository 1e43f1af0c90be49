// SPDX-License-Identifier: GPL-3.0-or-later
// A job's masks from its parts: the way of making them that its header names, and then, whatever
// the way, its printer's mask rules.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "driver/job/job.h"
#include "slicer/base/work.h"
#include "slicer/enhance/masks.h"

namespace binderjet {

// What the mask rules have changed in the layers that were made so far.
struct RuleTally {
  RuleChanges changes;
  std::int64_t layers = 0;  // with changes

  void add(const RuleChanges& of_layer);
};
// Says so to a person; empty if nothing was changed.
std::string rule_warning(const RuleTally& tally, const MaskRules& rules);

// `mesh` is the job's parts as one.
Pipeline<MaskLayer> job_masks(const JobHeader& header, std::shared_ptr<const Mesh> mesh,
                              const Work& work = {});

}  // namespace binderjet
