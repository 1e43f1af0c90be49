// SPDX-License-Identifier: GPL-3.0-or-later
// Parts on the bed: units, scale and rotation, then a spot at a pixel corner for each.
#pragma once

#include <array>
#include <initializer_list>
#include <optional>
#include <string>
#include <vector>

#include "slicer/mesh/mesh.h"

namespace binderjet {

// What a Placement may hold; a job's header and the options that lead there have the same bounds.
inline constexpr double kLeastScale = 1e-9;
inline constexpr double kMostScale = 1e9;
inline constexpr double kMostWallMm = 1e6;
inline constexpr double kMostDegrees = 1e9;

struct Placement {
  double unit_mm = 1.0;  // what one unit of the file is
  double scale = 1.0;
  std::array<double, 3> rotate_deg{};          // about x, then y, then z
  std::optional<std::array<double, 2>> at_mm;  // lower corner of the box on the bed; none: chosen
  double wall_mm = 0;  // thickness given to a surface that encloses nothing; 0: none is given
};

struct Bed {
  std::array<double, 3> size_mm;
  std::array<double, 2> pitch_mm;  // of the printer's pixels

  // Whole pixels on the bed along x or y.
  int pixels(int axis) const;
};

// The pixel whose lower corner is the part's lower corner.
struct BedSpot {
  int x_px = 0;
  int y_px = 0;
};

// What a part asks for.
struct BedRequest {
  std::string where;  // the file, for messages
  Point size_mm{};
  std::optional<std::array<double, 2>> at_mm;
  bool unit_declared = false;
  double scale = 1.0;  // the --scale that led to this size, for advice
};

// um, mm, cm, m, in, ft as millimeters; none for another word.
std::optional<double> unit_from_word(const std::string& word);

// Every coordinate times `factor`, one multiplication, then rotated about x, y and z. Multiples of
// 90 degrees are exact.
void transform_mesh(Mesh& mesh, double factor, const std::array<double, 3>& rotate_deg);

// Units, scale and rotation; then the lower corner of the bounding box is exactly 0, 0, 0.
// `along` are other points of the part, which move with it. Returns the box's size in mm. Throws
// Error for a scale that is not above 0.
Point transform_part(Mesh& mesh, const Placement& placement, const std::string& where,
                     std::initializer_list<std::vector<Point>*> along = {});

// A spot for every part, in the same order. A single part without a wish stands in the middle of
// the bed; several are laid in rows, `spacing_mm` apart and around those that have their spot, and
// the rows are centered if none has. Throws Error with the numbers if one does not fit, or if two
// wishes collide.
std::vector<BedSpot> place_parts(const std::vector<BedRequest>& parts, const Bed& bed,
                                 double spacing_mm);

// A warning about a part whose size looks like a mistake in the units; empty if it does not.
std::string doubtful_size(const BedRequest& part);

}  // namespace binderjet
