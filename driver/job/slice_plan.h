// SPDX-License-Identifier: GPL-3.0-or-later
// Slicing as slice and print share it: options, the header they lead to, and the encoded layers.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "driver/base/console.h"
#include "driver/job/estimate.h"
#include "driver/job/job.h"
#include "slicer/layers/pipeline.h"

namespace CLI {
class App;
}

namespace binderjet {

struct SliceOptions {
  std::vector<std::string> parts;
  std::string profile;
  std::string out;
  std::string enhance = "inverse";
  int passes = 2;
  bool robust = true;
  std::optional<double> layer_mm;
  std::string units;
  Placement placement;
  std::vector<std::string> at;
  std::string layers;
  std::string texture;
  bool color_enhance = false;
};

// The options that say how to slice: all but the parts, the profile, the output and --layers.
void add_slice_options(CLI::App& verb, SliceOptions& options);

// "A:B" as layers A <= k < B of so many; empty text is all of them. Error{kUsage} else.
LayerRange layer_range(const std::string& text, int layers);

struct SlicePlan {
  JobHeader header;
  std::shared_ptr<const Mesh> mesh;
  std::shared_ptr<const ColorField> color;  // null: no part has any
  std::vector<std::string> warnings;
  bool doubtful_size = false;  // of a part; a warning says which unit is likely
};

// Reads and places the parts; says the warnings.
SlicePlan plan_slices(const SliceOptions& options, const Console& console);

// The records of the job's layers.
Pipeline<EncodedLayer> encoded_layers(const JobHeader& header, std::shared_ptr<const Mesh> mesh,
                                      std::shared_ptr<const ColorField> color);

}  // namespace binderjet
