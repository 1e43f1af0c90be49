// SPDX-License-Identifier: GPL-3.0-or-later
// What a job says of itself: profile, grid, box, where each part came from and how it was placed.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "driver/profile/profile.h"
#include "slicer/color/color.h"
#include "slicer/layers/grid.h"
#include "slicer/mesh/mesh.h"
#include "slicer/mesh/paint.h"
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
  std::string enhance = "none";
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

// `where` names the job in messages. Error{kBadInput} if this is no header of ours.
JobHeader parse_job_header(const std::string& text, const std::string& where);

// A part read from its file, repaired, in millimetres and turned, its lower corner at (0, 0, 0).
struct Part {
  Mesh mesh;
  Paint paint;    // in the same coordinates
  Source source;  // corner_px is not yet decided
  BedRequest request;
  std::vector<std::string> warnings;
  bool doubtful_size = false;  // its file is probably in another unit; a warning says which
};
// `unit_mm` overrides what the file declares. Paint is left out unless asked for.
Part load_part(const std::string& file, std::optional<double> unit_mm, const Placement& placement,
               bool with_paint = false);

// The lower corner of all parts on the bed, in pixels.
std::array<int, 2> lower_corner(const std::vector<Source>& sources);

// The color of the parts in the job's coordinates, taken from them; none if no part has any.
// Warnings name the part.
std::shared_ptr<const ColorField> take_color(std::vector<Part>& parts, const Grid& grid,
                                             const ColorSettings& settings,
                                             std::vector<std::string>& warnings);

// The parts as one mesh in the job's coordinates: the lower corner of them all at (0, 0, 0).
Mesh merge_parts(std::vector<Part> parts, const Grid& grid);

// The job's parts read once more from their files; `folder` is where relative names are also tried.
// Error{kBadInput} if a file is gone or is not the file that was sliced.
std::shared_ptr<const Mesh> reload_parts(const JobHeader& header, const std::string& folder);

}  // namespace binderjet
