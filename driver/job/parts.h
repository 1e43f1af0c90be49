// SPDX-License-Identifier: GPL-3.0-or-later
// The parts of a job, from their files to one mesh and one color in the job's coordinates.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "driver/job/job.h"
#include "slicer/base/work.h"
#include "slicer/color/color.h"
#include "slicer/mesh/mesh.h"
#include "slicer/mesh/paint.h"
#include "slicer/mesh/place.h"

namespace binderjet {

// A part read from its file, repaired, in millimeters and turned, its lower corner at (0, 0, 0).
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
               bool with_paint = false, const Work& work = {});

// The color of the parts in the job's coordinates, taken from them; none if no part has any.
// Warnings name the part.
std::shared_ptr<const ColorField> take_color(std::vector<Part>& parts, const Grid& grid,
                                             const ColorSettings& settings,
                                             std::vector<std::string>& warnings, const Work& work);

// The parts as one mesh in the job's coordinates: the lower corner of them all at (0, 0, 0).
Mesh merge_parts(std::vector<Part> parts, const Grid& grid);

// The job's parts read once more from their files; `folder` is where relative names are also tried.
// Error{kBadInput} if a file is gone or is not the file that was sliced.
std::shared_ptr<const Mesh> reload_parts(const JobHeader& header, const std::string& folder,
                                         const Work& work);

// Where the files of the job's parts are, as reload_parts() looks for them.
std::vector<std::string> part_files(const JobHeader& header, const std::string& folder);

}  // namespace binderjet
