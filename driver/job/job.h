// SPDX-License-Identifier: GPL-3.0-or-later
// What a job says of itself: profile, grid, box, where each part came from and how it was placed.
#pragma once

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "driver/job/enhancement.h"
#include "driver/profile/profile.h"
#include "slicer/layers/grid.h"
#include "slicer/mesh/mesh.h"
#include "slicer/mesh/place.h"

namespace binderjet {

// One part of a job: its file, and what turns the file's numbers into a place on the bed.
struct Source {
  std::string file;  // as it was given
  std::string hash;  // of the file's bytes when it was sliced
  Placement placement;
  std::array<int, 2> corner_px{};  // the part's lower corner on the bed
};

struct JobHeader {
  Profile profile;
  Grid grid;
  JobBox box;
  Enhancement enhance = Enhancement::kNone;
  int passes = 0;
  bool robust = true;           // inverse: for the process window, not for the nominal model only
  bool color = false;           // it has color records
  bool color_enhanced = false;  // with creases darkened
  std::vector<Source> sources;

  int layers() const { return box.size_px[2]; }
  // The box's lower corner on the bed.
  std::array<double, 3> origin_mm() const;
};

// One JSON object; the same header gives the same bytes.
std::string to_text(const JobHeader& header);

// The lower corner of all parts on the bed, in pixels.
std::array<int, 2> lower_corner(const std::vector<Source>& sources);

// `where` names the job in messages. Error{kBadInput} if this is no header of ours.
JobHeader parse_job_header(const std::string& text, const std::string& where);

}  // namespace binderjet
