// SPDX-License-Identifier: GPL-3.0-or-later
// What slice, print and check are told of how to slice, and how the command line says so.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "driver/job/enhancement.h"
#include "slicer/layers/stream.h"
#include "slicer/mesh/place.h"

namespace CLI {
class App;
}

namespace binderjet {

struct SliceOptions {
  std::vector<std::string> parts;
  std::string profile;
  std::string out;
  Enhancement enhance = Enhancement::kInverse;
  int passes = 2;
  bool robust = true;
  std::optional<double> layer_mm;
  std::string units;
  std::optional<double> size_mm;  // of each part's largest side, instead of a scale
  Placement placement;
  std::vector<std::string> at;
  std::string layers;
  std::string texture;
  bool color_enhance = false;
};

// The options that say how to slice: all but the parts, the profile, the output and --layers.
void add_slice_options(CLI::App& verb, SliceOptions& options);

// The unit of --units in millimeters, if it is given; X,Y of an --at.
std::optional<double> unit_of(const SliceOptions& options);
std::array<double, 2> bed_place(const std::string& at);

// "A:B" as layers A <= k < B of so many; empty text is all of them. Error{kUsage} else.
LayerRange layer_range(const std::string& text, int layers);

}  // namespace binderjet
