// SPDX-License-Identifier: GPL-3.0-or-later
// Wavefront OBJ: the points and faces of all groups; what else stands in the file is read past.
#include <fmt/format.h>

#include <cmath>
#include <string>
#include <vector>

#include "slicer/error.h"
#include "slicer/mesh/readers.h"

namespace binderjet {
namespace {

class ObjReader {
 public:
  explicit ObjReader(InputFile& file) : file_(file) {}

  MeshFile read() {
    std::string_view text;
    std::string joined;
    while (file_.line(text)) {
      // A backslash at the end of a line continues it.
      joined.clear();
      while (text.ends_with('\\')) {
        joined.append(text.substr(0, text.size() - 1));
        joined += ' ';
        if (joined.size() > InputFile::kBuffer) {
          throw Error(ErrorKind::kBadInput, file_.here(), "is continued for over 1 MiB");
        }
        if (!file_.line(text)) text = {};
      }
      if (!joined.empty()) text = joined.append(text);
      Words words(text);
      const std::string_view keyword = words.next();
      if (keyword == "v") take_point(words);
      if (keyword == "f") take_face(words);
    }
    if (highest_ > static_cast<std::int64_t>(result_.mesh.points.size())) {
      refuse_index(highest_where_, highest_);
    }
    if (odd_colors_ > 0) {
      result_.warnings.push_back(counted(odd_colors_, "point has a colour", "points have colours") +
                                 " that is no number; ignored");
    }
    return std::move(result_);
  }

 private:
  std::string face_here() const { return fmt::format("{} (face {})", file_.here(), faces_); }

  [[noreturn]] void refuse_index(const std::string& where, std::int64_t index) const {
    throw Error(ErrorKind::kBadInput, where,
                fmt::format("names point {}, but points go from 1 to {} there; export the model "
                            "again",
                            index, result_.mesh.points.size()));
  }

  void take_point(Words& words) {
    Point point{};
    for (double& value : point) {
      const std::string_view word = words.next();
      if (!parse_number(word, value) || !std::isfinite(value)) {
        throw Error(
            ErrorKind::kBadInput, file_.here(),
            fmt::format("\"{}\" is no finite number; export the model again", word.substr(0, 40)));
      }
    }
    // A fourth number is a weight, or four to six numbers are a colour: neither moves the point.
    bool odd = false;
    for (std::string_view word = words.next(); !word.empty(); word = words.next()) {
      double value = 0;
      odd |= parse_number(word, value) && !std::isfinite(value);
    }
    odd_colors_ += odd ? 1 : 0;
    result_.mesh.points.push_back(point);
  }

  void take_face(Words& words) {
    ++faces_;
    corners_.clear();
    const auto count = static_cast<std::int64_t>(result_.mesh.points.size());
    for (std::string_view word = words.next(); !word.empty(); word = words.next()) {
      std::int64_t index = 0;
      if (!parse_number(word.substr(0, word.find('/')), index)) {
        throw Error(ErrorKind::kBadInput, face_here(),
                    fmt::format("\"{}\" is no corner; export the model again", word.substr(0, 40)));
      }
      // Points may follow the faces that name them, so the upper bound waits for the end.
      const std::int64_t point = index < 0 ? count + index + 1 : index;
      if (point < 1 || point > 0x7fffffff) refuse_index(face_here(), index);
      if (point > highest_) {
        highest_ = point;
        if (point > count) highest_where_ = face_here();
      }
      corners_.push_back(static_cast<int>(point - 1));
    }
    if (corners_.size() < 3) {
      throw Error(ErrorKind::kBadInput, face_here(), "has fewer than three corners");
    }
    add_polygon(result_.mesh, corners_);
  }

  InputFile& file_;
  MeshFile result_;
  std::vector<int> corners_;
  std::int64_t faces_ = 0;
  std::int64_t highest_ = 0;
  std::string highest_where_;
  std::int64_t odd_colors_ = 0;
};

}  // namespace

MeshFile read_obj(InputFile& file) { return ObjReader(file).read(); }

}  // namespace binderjet
