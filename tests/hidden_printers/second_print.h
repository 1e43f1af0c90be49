// SPDX-License-Identifier: GPL-3.0-or-later
// The closed loop on a hidden printer: a part is printed as declared, measured, calibrated, and
// printed again with masks for the calibrated profile. Which masks bring it nearest to the model?
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "slicer/calibrate/job/calibration.h"
#include "slicer/enhance/rules/mask_rules.h"
#include "slicer/mesh/mesh.h"
#include "slicer/score/voxel_counts.h"
#include "tests/hidden_printers/hidden_printer.h"

namespace binderjet::hidden {

// What came out of the powder against the model that was wanted.
struct PrintScore {
  VoxelCounts voxels;
  std::int64_t lost = 0;
  std::int64_t fused = 0;
  std::int64_t spurious = 0;
};

struct Loop {
  Calibration found;
  std::map<std::string, PrintScore> second;  // by --enhance's word, for the calibrated profile
};

// A mesh whose lower corner is at (0, 0, 0), in mm.
struct Wanted {
  std::shared_ptr<const Mesh> mesh;
  Box box;
};
Wanted scaled(Mesh mesh, double scale);

// `calibrated_on` is printed twice for the calibration, with noise; `wanted` is what the loop is
// judged by, without the noise that no mask can answer.
Loop close_loop(const Printer& printer, const Wanted& calibrated_on, const Wanted& wanted,
                const std::vector<EffectSpec>& declared, const MaskRules& rules);

}  // namespace binderjet::hidden
