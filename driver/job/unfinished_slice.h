// SPDX-License-Identifier: GPL-3.0-or-later
// The layers of a slice that are done, on the disk beside the job's name until the job has it. What
// Ctrl-C, kill -9, a full disk or a loss of power left of them is gone on with.
//
//   part.bjob.1f0c64d2a53b9e07.part     a job file without its end
//   part.bjob.1f0c64d2a53b9e07.totals   a line for each layer, "12 4711 9422 0 0": its number and
//                                       what Totals counts of it, which the job does not hold
//
// The digits are a hash of all that the layers depend on: models, profile, options, and this
// program. What another of them left has another name, so it cannot be taken for this one's.
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "driver/base/console.h"
#include "driver/job/encoded_layers.h"
#include "driver/job/estimate.h"
#include "driver/job/slice_plan.h"
#include "slicer/layers/stream.h"
#include "transport/base/file.h"
#include "transport/job/job_file.h"

namespace binderjet {

class UnfinishedSlice {
 public:
  // Takes up what there is of `layers` of the job `out`, or begins: also if there is some, with
  // `restart`. Says so, and what becomes of the layers of other slices to `out`. Error{kUsage} if
  // another process is at the same slice.
  UnfinishedSlice(const std::string& out, const SlicePlan& plan, LayerRange layers, bool restart,
                  const Console& console);
  // Whole layers stay; without any, nothing does.
  ~UnfinishedSlice();
  UnfinishedSlice(const UnfinishedSlice&) = delete;
  UnfinishedSlice& operator=(const UnfinishedSlice&) = delete;

  // The layers still to come, and the totals of those that are there.
  LayerRange rest() const { return {layers_.first + totals_.layers, layers_.last}; }
  const Totals& totals() const { return totals_; }

  // The next ones. A loss of power costs what came within the last seconds.
  void append(const std::vector<Shared<EncodedLayer>>& next);
  // The job gets its name; nothing else is left, neither of this slice nor of others to `out`.
  void finish();

  // What to add to an error that ends the slice: "; layers 0 to 411 of 1161 are kept, ...", or "".
  std::string kept() const;

 private:
  using Clock = std::chrono::steady_clock;

  void take_up(const std::string& header, bool color);
  void find_others(const Console& console);

  std::string out_;
  LayerRange layers_;
  int job_layers_;
  std::string stem_;  // the files' names without their ends
  File totals_file_;  // whose lock is that of both
  std::optional<JobWriter> writer_;
  Totals totals_;
  std::vector<std::string> others_;  // stems of what other slices left
  Clock::time_point synced_;
};

}  // namespace binderjet
