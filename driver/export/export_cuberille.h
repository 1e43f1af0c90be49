// SPDX-License-Identifier: GPL-3.0-or-later
// A job's masks as the mesh of their voxels (paper, 4.3).
#pragma once

#include <string>

#include "driver/base/give_name.h"
#include "driver/job/mask_source.h"
#include "slicer/base/work.h"

namespace binderjet {

// Writes the PLY layer by layer, and returns what gives it its name.
[[nodiscard]] GiveName export_cuberille(const MaskSource& job, const std::string& path,
                                        const Work& work);

}  // namespace binderjet
