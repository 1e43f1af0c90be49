// SPDX-License-Identifier: GPL-3.0-or-later
// Units, exact rotations, and rows of boxes on the bed in whole pixels.
#include "slicer/mesh/place.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <utility>

#include "slicer/base/error.h"

namespace binderjet {
namespace {

constexpr double kFarthest = 1e6;    // mm; what is told of a place is an int in pixels
constexpr double kTolerance = 1e-6;  // mm; rounding must not push a part off the bed

std::string size_text(const Point& size) {
  // Three digits of the smallest side at least, so that 0.044 mm is not 0.0 mm.
  const double least = std::min({size[0], size[1], size[2]});
  if (least < 1) return fmt::format("{:.3g} x {:.3g} x {:.3g} mm", size[0], size[1], size[2]);
  return fmt::format("{:.1f} x {:.1f} x {:.1f} mm", size[0], size[1], size[2]);
}

std::string bed_text(const Bed& bed) {
  return fmt::format("{:g} x {:g} x {:g} mm", bed.size_mm[0], bed.size_mm[1], bed.size_mm[2]);
}

// Sine and cosine, exact where they are whole numbers.
std::pair<double, double> sine_cosine(double degrees) {
  const double quarter = degrees / 90;
  if (quarter == std::floor(quarter)) {
    const int turn = static_cast<int>(std::fmod(std::fmod(quarter, 4) + 4, 4));
    constexpr std::array<double, 4> kSine = {0, 1, 0, -1};
    return {kSine[static_cast<std::size_t>(turn)], kSine[static_cast<std::size_t>((turn + 1) % 4)]};
  }
  const double radians = degrees * std::numbers::pi / 180;
  return {std::sin(radians), std::cos(radians)};
}

// The whole pixels that a length covers from a pixel corner on.
int pixels_of(double size_mm, double pitch_mm) {
  return std::max(1, static_cast<int>(std::ceil((size_mm - kTolerance) / pitch_mm)));
}

struct Rectangle {
  int x, y, width, depth;

  bool meets(const Rectangle& other, int gap_x, int gap_y) const {
    return x < other.x + other.width + gap_x && other.x < x + width + gap_x &&
           y < other.y + other.depth + gap_y && other.y < y + depth + gap_y;
  }
};

class Layout {
 public:
  Layout(const std::vector<BedRequest>& parts, const Bed& bed, double spacing_mm)
      : parts_(parts),
        bed_(bed),
        gap_x_(static_cast<int>(std::ceil(spacing_mm / bed.pitch_mm[0]))),
        gap_y_(static_cast<int>(std::ceil(spacing_mm / bed.pitch_mm[1]))) {}

  std::vector<BedSpot> place() {
    std::vector<BedSpot> spots(parts_.size());
    std::vector<std::size_t> loose;
    for (std::size_t i = 0; i < parts_.size(); ++i) {
      check_size(parts_[i]);
      if (const auto& at_mm = parts_[i].at_mm) {
        spots[i] = place_fixed(i, *at_mm);
      } else {
        loose.push_back(i);
      }
    }
    if (parts_.size() == 1 && !loose.empty()) return {middle(parts_[0])};
    place_rows(loose, spots);
    return spots;
  }

 private:
  Rectangle rectangle(const BedRequest& part) const {
    return {0, 0, pixels_of(part.size_mm[0], bed_.pitch_mm[0]),
            pixels_of(part.size_mm[1], bed_.pitch_mm[1])};
  }

  bool fits(const Point& size) const {
    for (std::size_t a = 0; a < 3; ++a) {
      if (!(size[a] <= bed_.size_mm[a] + kTolerance)) return false;
    }
    return true;
  }

  // The last pixel corner of an axis where a part that fits still ends on the bed. Of the bed, not
  // of its pixels, the last of which may reach over the edge.
  int last_corner(int axis, double size_mm) const {
    const auto a = static_cast<std::size_t>(axis);
    return static_cast<int>(
        std::max(0.0, std::floor((bed_.size_mm[a] - size_mm + kTolerance) / bed_.pitch_mm[a])));
  }

  bool on_bed(int x, int y, const Point& size) const {
    return x >= 0 && y >= 0 && x <= last_corner(0, size[0]) && y <= last_corner(1, size[1]);
  }

  void check_size(const BedRequest& part) const {
    const Point& size = part.size_mm;
    if (fits(size)) return;
    double scale = bed_.size_mm[2] / size[2];
    for (int axis = 0; axis < 2; ++axis) {
      const auto a = static_cast<std::size_t>(axis);
      scale = std::min(scale, bed_.size_mm[a] / size[a]);
    }
    // Two digits, rounded down, so that the advice is easy to type and true.
    const double advice = scale * part.scale;
    const double step = std::pow(10.0, std::floor(std::log10(advice)) - 1);
    std::string hint = fmt::format("; --scale {:.2g} would", std::floor(advice / step) * step);
    const auto turned = [&](int a, int b) {
      Point other = size;
      std::swap(other[static_cast<std::size_t>(a)], other[static_cast<std::size_t>(b)]);
      return fits(other);
    };
    if (turned(0, 1)) hint += ", and so would a turn by 90 degrees about z";
    if (!turned(0, 1) && turned(1, 2)) hint += ", and so would a turn by 90 degrees about x";
    if (!turned(0, 1) && !turned(1, 2) && turned(0, 2)) {
      hint += ", and so would a turn by 90 degrees about y";
    }
    if (!part.unit_declared && scale < 1.0 / 3) {
      hint += fmt::format("; if the file is in micrometers, say --units um ({})",
                          size_text({size[0] / 1000, size[1] / 1000, size[2] / 1000}));
    }
    throw Error(
        ErrorKind::kBadInput, part.where,
        fmt::format("{} does not fit the bed of {}{}", size_text(size), bed_text(bed_), hint));
  }

  BedSpot place_fixed(std::size_t index, const std::array<double, 2>& at_mm) {
    const BedRequest& part = parts_[index];
    Rectangle place = rectangle(part);
    for (const double mm : at_mm) {
      if (!(std::abs(mm) <= kFarthest)) {
        throw Error(ErrorKind::kUsage, part.where,
                    fmt::format("cannot stand at {:g},{:g}; --at takes millimeters of the bed",
                                at_mm[0], at_mm[1]));
      }
    }
    place.x = static_cast<int>(std::lround(at_mm[0] / bed_.pitch_mm[0]));
    place.y = static_cast<int>(std::lround(at_mm[1] / bed_.pitch_mm[1]));
    if (!on_bed(place.x, place.y, part.size_mm)) {
      throw Error(
          ErrorKind::kBadInput, part.where,
          fmt::format("at {:g},{:g} it reaches {:.1f},{:.1f} mm, off the bed of {}; --at up "
                      "to {:.1f},{:.1f} fits",
                      at_mm[0], at_mm[1], at_mm[0] + part.size_mm[0], at_mm[1] + part.size_mm[1],
                      bed_text(bed_), last_corner(0, part.size_mm[0]) * bed_.pitch_mm[0],
                      last_corner(1, part.size_mm[1]) * bed_.pitch_mm[1]));
    }
    for (std::size_t i = 0; i < taken_.size(); ++i) {
      // Who says --at may put parts as near as he likes, but not into each other.
      if (place.meets(taken_[i], 0, 0)) {
        throw Error(ErrorKind::kBadInput, part.where,
                    fmt::format("at {:g},{:g} it stands in {}; choose another --at", at_mm[0],
                                at_mm[1], parts_[owners_[i]].where));
      }
    }
    take(place, index);
    return {place.x, place.y};
  }

  BedSpot middle(const BedRequest& part) const {
    const auto center = [&](int axis) {
      const auto a = static_cast<std::size_t>(axis);
      const double corner = (bed_.size_mm[a] - part.size_mm[a]) / 2;
      const int nearest = static_cast<int>(std::lround(corner / bed_.pitch_mm[a]));
      return std::clamp(nearest, 0, last_corner(axis, part.size_mm[a]));
    };
    return {center(0), center(1)};
  }

  // Rows of falling depth: the first part of a row is its deepest.
  void place_rows(std::vector<std::size_t>& loose, std::vector<BedSpot>& spots) {
    const bool any_fixed = !taken_.empty();
    std::stable_sort(loose.begin(), loose.end(), [&](std::size_t a, std::size_t b) {
      return rectangle(parts_[a]).depth > rectangle(parts_[b]).depth;
    });
    int row_y = 0;
    int row_depth = 0;
    int x = 0;
    for (const std::size_t index : loose) {
      Rectangle place = rectangle(parts_[index]);
      place.x = x;
      place.y = row_y;
      while (!settle(place, parts_[index].size_mm)) {
        // The next row begins behind this one, or a pixel on where this one had no room at all.
        row_y += row_depth > 0 ? row_depth + gap_y_ : 1;
        row_depth = 0;
        place.x = 0;
        place.y = row_y;
        if (row_y > last_corner(1, parts_[index].size_mm[1])) refuse(index);
      }
      take(place, index);
      spots[index] = {place.x, place.y};
      row_depth = std::max(row_depth, place.depth);
      x = place.x + place.width + gap_x_;
    }
    if (!any_fixed) center_all(loose, spots);
  }

  // Moves right along its row past what stands there; false if the row has no room left.
  bool settle(Rectangle& place, const Point& size) const {
    bool moved = true;
    while (moved) {
      moved = false;
      for (const Rectangle& other : taken_) {
        if (place.meets(other, gap_x_, gap_y_)) {
          place.x = other.x + other.width + gap_x_;
          moved = true;
        }
      }
    }
    return on_bed(place.x, place.y, size);
  }

  [[noreturn]] void refuse(std::size_t index) const {
    double area = 0;
    for (const BedRequest& part : parts_) area += part.size_mm[0] * part.size_mm[1];
    throw Error(ErrorKind::kBadInput, parts_[index].where,
                fmt::format("{} finds no room beside the {} of {} parts that are placed; all cover "
                            "{:.0f} of {:.0f} mm2; print fewer at once or use --at",
                            size_text(parts_[index].size_mm), taken_.size(), parts_.size(), area,
                            bed_.size_mm[0] * bed_.size_mm[1]));
  }

  void center_all(const std::vector<std::size_t>& loose, std::vector<BedSpot>& spots) const {
    int right = 0;
    int back = 0;
    for (const Rectangle& place : taken_) {
      right = std::max(right, place.x + place.width);
      back = std::max(back, place.y + place.depth);
    }
    for (const std::size_t index : loose) {
      spots[index].x_px += (bed_.pixels(0) - right) / 2;
      spots[index].y_px += (bed_.pixels(1) - back) / 2;
    }
  }

  void take(const Rectangle& place, std::size_t index) {
    taken_.push_back(place);
    owners_.push_back(index);
  }

  const std::vector<BedRequest>& parts_;
  const Bed& bed_;
  int gap_x_, gap_y_;
  std::vector<Rectangle> taken_;
  std::vector<std::size_t> owners_;  // the part of each
};

}  // namespace

int Bed::pixels(int axis) const {
  const auto a = static_cast<std::size_t>(axis);
  // The last pixel may reach over the bed's edge: 203 mm are 2,398 pixels of 300 dpi.
  return static_cast<int>(std::ceil((size_mm[a] - kTolerance) / pitch_mm[a]));
}

std::optional<double> unit_from_word(const std::string& word) {
  if (word == "um" || word == "micron") return 0.001;
  if (word == "mm" || word == "millimeter") return 1.0;
  if (word == "cm" || word == "centimeter") return 10.0;
  if (word == "m" || word == "meter") return 1000.0;
  if (word == "in" || word == "inch") return 25.4;
  if (word == "ft" || word == "foot") return 304.8;
  return std::nullopt;
}

void transform_mesh(Mesh& mesh, double factor, const std::array<double, 3>& rotate_deg) {
  for (Point& point : mesh.points) {
    for (double& value : point) value *= factor;
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (rotate_deg[axis] == 0) continue;
    const auto [sine, cosine] = sine_cosine(rotate_deg[axis]);
    const std::size_t u = (axis + 1) % 3;
    const std::size_t v = (axis + 2) % 3;
    for (Point& point : mesh.points) {
      const double a = point[u];
      const double b = point[v];
      point[u] = cosine * a - sine * b;
      point[v] = sine * a + cosine * b;
    }
  }
}

Point transform_part(Mesh& mesh, const Placement& placement, const std::string& where,
                     std::initializer_list<std::vector<Point>*> along) {
  const double factor = placement.unit_mm * placement.scale;
  if (!(factor > 0) || !std::isfinite(factor)) {
    throw Error(
        ErrorKind::kUsage, where,
        fmt::format("cannot be scaled by {:g}; --scale takes a number above 0", placement.scale));
  }
  for (const double degrees : placement.rotate_deg) {
    if (!(std::abs(degrees) <= kMostDegrees)) {
      throw Error(ErrorKind::kUsage, where,
                  fmt::format("cannot be turned by {:g}; --rotate takes degrees, up to {:g}",
                              degrees, kMostDegrees));
    }
  }
  transform_mesh(mesh, factor, placement.rotate_deg);
  const Point corner = bounding_box(mesh).min;
  const auto shift = [&corner](std::vector<Point>& points) {
    for (Point& point : points) {
      for (std::size_t i = 0; i < 3; ++i) point[i] -= corner[i];
    }
  };
  shift(mesh.points);
  for (std::vector<Point>* points : along) {
    Mesh other{std::move(*points), {}};
    transform_mesh(other, factor, placement.rotate_deg);
    shift(other.points);
    *points = std::move(other.points);
  }
  const Box box = bounding_box(mesh);
  return box.max;
}

std::vector<BedSpot> place_parts(const std::vector<BedRequest>& parts, const Bed& bed,
                                 double spacing_mm) {
  return Layout(parts, bed, spacing_mm).place();
}

std::string doubtful_size(const BedRequest& part) {
  const Point& size = part.size_mm;
  const double largest = std::max({size[0], size[1], size[2]});
  if (part.unit_declared || largest >= 1) return "";
  // What is a part of some centimeters in meters was drawn in meters; else inches make more sense.
  constexpr double kLargePartMm = 250;
  const bool meters = largest * 1000 <= kLargePartMm;
  const auto advice = [&](const char* word, double unit_mm) {
    return fmt::format("--units {} ({})", word,
                       size_text({size[0] * unit_mm, size[1] * unit_mm, size[2] * unit_mm}));
  };
  const std::string m = advice("m", 1000);
  const std::string in = advice("in", 25.4);
  return fmt::format("the whole part is only {}; its file is probably in {}: say {}, or {}",
                     size_text(size), meters ? "meters" : "inches", meters ? m : in,
                     meters ? in : m);
}

}  // namespace binderjet
