// SPDX-License-Identifier: GPL-3.0-or-later
// Slicing as slice, print and check share it: what the options lead to, a header and placed parts.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "driver/base/console.h"
#include "driver/job/job.h"
#include "driver/job/slice_options.h"
#include "slicer/color/color.h"

namespace binderjet {

struct SlicePlan {
  JobHeader header;
  std::shared_ptr<const Mesh> mesh;
  std::shared_ptr<const ColorField> color;  // null: no part has any
  std::string fingerprint;  // of all that the layers are made from beside the header
  std::vector<std::string> warnings;
  bool doubtful_size = false;  // of a part; a warning says which unit is likely
};

// Reads and places the parts; says the warnings.
SlicePlan plan_slices(const SliceOptions& options, const Console& console);

}  // namespace binderjet
