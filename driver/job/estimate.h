// SPDX-License-Identifier: GPL-3.0-or-later
// What a sliced job will cost at the printer, and what slicing it cost here.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "driver/base/console.h"
#include "driver/job/encoded_layers.h"
#include "driver/job/job.h"
#include "driver/job/job_masks.h"

namespace binderjet {

struct Totals {
  int layers = 0;
  int kept = 0;  // of these, that an interrupted slice had left
  std::int64_t mask_px = 0;
  std::int64_t target_vx = 0;
  RuleTally rules;
  double seconds = 0;

  void add(const EncodedLayer& layer) {
    ++layers;
    mask_px += layer.mask_px;
    target_vx += layer.target_vx;
    rules.add(layer.rule_changes);
  }
};

// What printing takes of time and material.
struct Estimate {
  double print_minutes = 0;  // at the mean of the profile's rates, and drying
  double binder_ml = 0;
  double powder_ml = 0;  // wetted, and gone with the part
};
Estimate estimate_of(const JobHeader& header, const Totals& totals);
std::string text_of(const Estimate& estimate, const JobHeader& header);

// The result of `slice`, for a person or as JSON; says first what the mask rules have changed.
void report(const JobHeader& header, const Totals& totals, const std::string& out,
            std::vector<std::string> warnings, const Console& console);

}  // namespace binderjet
