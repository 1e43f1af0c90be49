// SPDX-License-Identifier: GPL-3.0-or-later
// OFF as text, with or without colors and normals: a header, points, faces.
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "slicer/base/error.h"
#include "slicer/mesh/read/readers.h"

namespace binderjet {
namespace {

// The file's words without comments. Points and faces may share lines or span them.
class OffWords {
 public:
  explicit OffWords(InputFile& file) : file_(file) {}

  std::string_view next() {
    std::string_view word = words_.next();
    while (word.empty() || word.starts_with('#')) {
      std::string_view text;
      if (!file_.line(text)) {
        throw Error(ErrorKind::kBadInput, file_.name(),
                    "ends before all points and faces that it declares; export it again");
      }
      words_ = Words(text);
      word = words_.next();
    }
    return word;
  }

  void skip_line() { words_ = Words({}); }
  // What is left of the line.
  std::string_view rest_of_line() {
    const std::string_view rest = words_.rest();
    skip_line();
    return rest;
  }

  std::int64_t integer() {
    const std::string_view word = next();
    std::int64_t value = 0;
    if (!parse_number(word, value)) refuse(word, "whole number");
    return value;
  }

  double number() {
    const std::string_view word = next();
    double value = 0;
    if (!parse_number(word, value) || !std::isfinite(value)) refuse(word, "finite number");
    return value;
  }

 private:
  [[noreturn]] void refuse(std::string_view word, const std::string& wanted) const {
    throw Error(ErrorKind::kBadInput, file_.here(),
                fmt::format("\"{}\" is no {}; export the model again", word.substr(0, 40), wanted));
  }

  InputFile& file_;
  Words words_{{}};
};

// Three or four numbers are a color: 0 to 1 if written with a point, else 0 to 255. One number is
// a place in a color map that nobody has.
std::optional<Rgb> color_in(std::string_view text, std::size_t skip = 0) {
  text = text.substr(0, text.find('#'));
  Words words(text);
  std::array<double, 4> values{};
  std::size_t count = 0;
  bool has_point = false;
  for (std::string_view word = words.next(); !word.empty(); word = words.next()) {
    if (skip > 0) {
      --skip;
      continue;
    }
    if (count == 4 || !parse_number(word, values[count])) return std::nullopt;
    if (!std::isfinite(values[count])) return std::nullopt;
    has_point |= word.find('.') != word.npos;
    ++count;
  }
  if (count < 3) return std::nullopt;
  const double full = has_point ? 1 : 255;
  return rgb_of(values[0] / full, values[1] / full, values[2] / full);
}

}  // namespace

MeshFile read_off(InputFile& file) {
  OffWords words(file);
  const std::string keyword(words.next());
  // ST, C and N announce more numbers behind each point; 4 and n other dimensions.
  const bool known = keyword == "OFF" || keyword == "COFF" || keyword == "NOFF" ||
                     keyword == "CNOFF" || keyword == "STOFF";
  if (!known) {
    throw Error(ErrorKind::kBadInput, file.here(),
                fmt::format("\"{}\" begins no OFF file that is known here; save it as plain OFF",
                            keyword.substr(0, 40)));
  }
  const std::int64_t points = words.integer();
  const std::int64_t faces = words.integer();
  words.integer();  // edges: many writers leave 0, nobody needs them
  // "0 0 0" and a line end is the shortest point, "3 0 1 2" the shortest face.
  check_claim(file, file.here(), points, 5, "points");
  check_claim(file, file.here(), faces, 7, "faces");

  MeshFile result;
  Painter painter;
  result.mesh.points.reserve(static_cast<std::size_t>(points));
  for (std::int64_t i = 0; i < points; ++i) {
    const double x = words.number();
    const double y = words.number();
    const double z = words.number();
    result.mesh.points.push_back({x, y, z});
    if (keyword == "OFF") continue;
    const std::string_view rest = words.rest_of_line();
    if (keyword != "COFF" && keyword != "CNOFF") continue;
    // Three numbers of a normal stand before the color.
    if (const auto color = color_in(rest, keyword == "CNOFF" ? 3 : 0)) {
      painter.add_sample({x, y, z}, *color);
    }
  }
  result.mesh.triangles.reserve(static_cast<std::size_t>(faces));
  std::vector<int> corners;
  for (std::int64_t i = 0; i < faces; ++i) {
    const std::int64_t count = words.integer();
    const std::string where = file.here();
    if (count < 3) {
      throw Error(ErrorKind::kBadInput, where, "is a face with fewer than three corners");
    }
    corners.clear();
    for (std::int64_t c = 0; c < count; ++c) {
      const std::int64_t index = words.integer();
      if (index < 0 || index >= points) {
        throw Error(
            ErrorKind::kBadInput, fmt::format("{} (face {})", file.here(), i + 1),
            fmt::format("names point {}, but points go from 0 to {}; export the model again", index,
                        points - 1));
      }
      corners.push_back(static_cast<int>(index));
    }
    painter.add_plain(corners.size() - 2, color_in(words.rest_of_line()));
    add_polygon(result.mesh, corners);
  }
  result.paint = painter.take(result.mesh);
  return result;
}

}  // namespace binderjet
