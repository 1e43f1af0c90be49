// SPDX-License-Identifier: GPL-3.0-or-later
// What the printer model makes of masks, of a job that is there or of one that is being sliced:
// streamed, and written as a slice stack.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>

#include "driver/base/give_name.h"
#include "driver/job/job_masks.h"
#include "driver/job/mask_source.h"
#include "slicer/base/work.h"
#include "slicer/layers/pipeline.h"
#include "slicer/model/printer_model.h"

namespace binderjet {

// The printed voxels of each mask; layers that the source lacks are powder. Source and model must
// outlive what is made of them.
Pipeline<RunLayer> printed_layers(const MaskSource& masks, const PrinterModel& model,
                                  const Work& work = {});
std::unique_ptr<Stream<RunLayer>> printed_stream(const MaskSource& masks, const PrinterModel& model,
                                                 const Work& work);

// What is counted of masks on their way into the printer model, on several threads.
struct MaskTally {
  std::atomic<std::int64_t> pixels = 0;
  std::mutex mutex;  // for the rules
  RuleTally rules;
};
// The same of a job that is being sliced; `mesh` is its parts as one.
Pipeline<RunLayer> printed_job(const JobHeader& header, std::shared_ptr<const Mesh> mesh,
                               std::shared_ptr<const PrinterModel> model,
                               std::shared_ptr<MaskTally> tally, const Work& work = {});

// Writes printed layers to `folder`, at the voxel pitch in x and y and one image per layer; returns
// what gives the folder its name.
[[nodiscard]] GiveName write_printed(const MaskSource& masks, const PrinterModel& model,
                                     const Grid& grid, const std::string& folder, const Work& work);

}  // namespace binderjet
