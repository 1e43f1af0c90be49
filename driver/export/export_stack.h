// SPDX-License-Identifier: GPL-3.0-or-later
// A job's layers as slice stacks: folders of PNGs with stack.json.
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "driver/base/give_name.h"
#include "driver/job/mask_source.h"
#include "slicer/base/work.h"
#include "slicer/mesh/mesh.h"

namespace binderjet {

// The job's masks as a stack: of its box, or of the whole bed with the box in its place.
StackInfo mask_info(const MaskSource& job, bool full_bed);
// Mask `index`, packed, in the frame that mask_info() gave.
std::vector<std::byte> mask_bits(const MaskSource& job, const StackInfo& frame, int index);
// Error{kUsage} if the job has no color.
void demand_color(const MaskSource& job);

// These write a stack of the job's layers, and return what gives the folder its name.
[[nodiscard]] GiveName export_masks(const MaskSource& job, const std::string& folder, bool full_bed,
                                    const Work& work);
// Every slice of the voxels that are wanted; `mesh` is the job's models as one (reload_parts()).
[[nodiscard]] GiveName export_target(const MaskSource& job, std::shared_ptr<const Mesh> mesh,
                                     const std::string& folder, const Work& work);
[[nodiscard]] GiveName export_color(const MaskSource& job, const std::string& folder,
                                    const Work& work);
// Three stacks of drops, each in a folder of its ink's name.
inline constexpr std::array<const char*, 3> kInks = {"cyan", "magenta", "yellow"};
[[nodiscard]] GiveName export_planes(const MaskSource& job, const std::string& folder,
                                     const Work& work);

}  // namespace binderjet
