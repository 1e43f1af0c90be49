// SPDX-License-Identifier: GPL-3.0-or-later
// A job's layers as slice stacks: folders of PNGs with stack.json.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "driver/base/console.h"
#include "driver/job/mask_source.h"

namespace binderjet {

// The job's masks as a stack: of its box, or of the whole bed with the box in its place.
StackInfo mask_info(const MaskSource& job, bool full_bed);
// Mask `index`, packed, in the frame that mask_info() gave.
std::vector<std::byte> mask_bits(const MaskSource& job, const StackInfo& frame, int index);
// Error{kUsage} if the job has no color.
void demand_color(const MaskSource& job);

void export_masks(const MaskSource& job, const std::string& folder, bool full_bed,
                  const Console& console);
// Every slice of the voxels that are wanted, made again from the job's models.
void export_target(const MaskSource& job, const std::string& folder, const Console& console);
void export_color(const MaskSource& job, const std::string& folder, const Console& console);
// Three stacks of drops: cyan, magenta and yellow, each in a folder of its name.
void export_planes(const MaskSource& job, const std::string& folder, const Console& console);

}  // namespace binderjet
