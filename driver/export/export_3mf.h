// SPDX-License-Identifier: GPL-3.0-or-later
// A job as a 3MF image stack: its masks as a level set, its color as volume data.
//
// Source: 3MF Volumetric Extension 0.8 (namespace volumetric/2022/01), chapters 2 to 5; 3MF Core
// 1.3 for the package. What a sheet's pixel covers is exact, for sampling is "nearest" and the
// image spans the box of the job: u and x, v and y, w and z go the same way, and a picture's first
// row is v = 1. A mask's 1 becomes -0.5 and its 0 becomes 0.5, so the surface lies where the level
// is 0.
#pragma once

#include <string>

#include "driver/base/give_name.h"
#include "driver/job/mask_source.h"
#include "slicer/base/work.h"

namespace binderjet {

// Writes the archive layer by layer, and returns what gives it its name.
[[nodiscard]] GiveName export_3mf(const MaskSource& job, const std::string& path, const Work& work);

}  // namespace binderjet
