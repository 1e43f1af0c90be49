// SPDX-License-Identifier: GPL-3.0-or-later
// The score of masks on one sheet: under the printer's own model in full, over its process window
// as the mean and the worst excess.
#pragma once

#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "driver/job/mask_source.h"
#include "slicer/base/work.h"
#include "slicer/enhance/rules/mask_regions.h"
#include "slicer/mesh/mesh.h"
#include "slicer/model/printer_model.h"
#include "slicer/score/score.h"

namespace binderjet {

struct ScoreSheet {
  JobScore score;
  double window_mean = 0;  // excess, over the model and the corners of its window
  double window_worst = 0;
  MaskRegions masks;
  // located(): the deepest wrong voxel; null if no voxel counts.
  nlohmann::ordered_json deepest;
};

// Hears of the layers from the first on, a block at a time, with the faults that end there; then of
// nothing but the faults of which only the end tells.
using ScoreListener =
    std::function<void(const std::vector<Shared<LayerScore>>&, const std::vector<Fault>&)>;

// `models` is process_window(): the first is the printer's own. The target is the job's.
ScoreSheet score_masks(const MaskSource& masks, const JobHeader& header,
                       const std::shared_ptr<const Mesh>& target,
                       const std::vector<PrinterModel>& models, const Work& work,
                       const ScoreListener& listener = {});

// The masks that the profile and the enhancement of this header make of the target in place of the
// job's own.
MaskSource enhanced_masks(const MaskSource& job, JobHeader header,
                          const std::shared_ptr<const Mesh>& target, const Work& work);

nlohmann::ordered_json to_json(const ScoreSheet& sheet);

}  // namespace binderjet
