// SPDX-License-Identifier: GPL-3.0-or-later
// A printer's profile: grid, bed, effects, speed and device, read from one strict TOML file.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "slicer/color/color.h"
#include "slicer/enhance/rules/mask_rules.h"
#include "slicer/layers/grid.h"
#include "slicer/mesh/place.h"
#include "slicer/model/effects/effect.h"

namespace binderjet {

// What the powder can carry: a rule of thumb for check, which no mask and no score depends on.
// Unset: check does not look.
struct StrengthRules {
  std::optional<double> thinnest_mm;   // walls and pins below may break when they are brushed off
  std::optional<double> narrowest_mm;  // slots and holes below may keep their powder
};

struct Profile {
  std::string name;
  std::string source;  // where the numbers come from
  std::string path;    // the file, or what stands for it ("job.bjob: profile")
  std::string text;    // the file's own bytes
  std::array<double, 2> dpi{};
  std::vector<double> layer_mm;  // the first is the default
  std::array<int, 3> detail_vx{2, 2, 2};
  std::array<double, 3> bed_mm{};
  std::vector<EffectSpec> effects;  // in the order of the file
  std::array<double, 2> layers_per_minute{};
  double dry_minutes = 0;
  // Binder volume per volume of wetted powder: 68.4 pl a drop over 63.5 x 59.9 x 50 um (Addit.
  // Manuf. 39:101870, table 2) is 0.36, 90 % of the pores of powder packed at 60 %. An estimate
  // where [binder] does not say better.
  double binder_per_powder = 0.36;
  MaskRules mask;
  StrengthRules strength;
  ColorSettings color;
  std::string protocol;
  std::vector<std::string> usb;  // "vid:pid", then words of transport/usb/usb_quirks.h

  // The grid with the default layer or the one asked for; Error{kUsage} if the printer has no such.
  Grid grid(std::optional<double> layer) const;
  Bed bed(const Grid& grid) const { return {bed_mm, {grid.pitch_mm[0], grid.pitch_mm[1]}}; }
};

// Where profiles are looked for by name: the source tree's folder, then the installed one.
std::vector<std::string> profile_folders();

// A name in one of those folders (case does not matter) or a path. Error{kBadInput} with line and
// column.
Profile load_profile(const std::string& name_or_path);
// The profile whose file has this text; `path` is for messages.
Profile parse_profile(const std::string& text, const std::string& path);

}  // namespace binderjet
