// SPDX-License-Identifier: GPL-3.0-or-later
// Wavefront OBJ: the points and faces of all groups, with the colors of points, materials and
// images.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "slicer/base/error.h"
#include "slicer/mesh/read/materials.h"
#include "slicer/mesh/read/readers.h"

namespace binderjet {
namespace {

class ObjReader {
 public:
  ObjReader(InputFile& file, const std::string& path) : file_(file), path_(path) {}

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
      if (keyword == "vt") take_uv(words);
      if (keyword == "mtllib") take_library(words);
      if (keyword == "usemtl") use_material(name_in(words));
    }
    if (highest_ > static_cast<std::int64_t>(result_.mesh.points.size())) {
      refuse_index(highest_where_, highest_);
    }
    if (odd_colors_ > 0) {
      result_.warnings.push_back(counted(odd_colors_, "point has a color", "points have colors") +
                                 " that is no number; ignored");
    }
    finish_colors();
    return std::move(result_);
  }

 private:
  static std::string name_in(const Words& words) {
    std::string_view name = words.rest();
    while (!name.empty() && (name.front() == ' ' || name.front() == '\t')) name.remove_prefix(1);
    while (!name.empty() && (name.back() == ' ' || name.back() == '\t')) name.remove_suffix(1);
    return std::string(name);
  }

  // One name that may hold spaces, or several names.
  void take_library(Words words) {
    const std::string all = name_in(words);
    std::string found = file_beside(path_, all);
    if (!found.empty()) {
      read_materials(found, materials_);
      return;
    }
    for (std::string_view word = words.next(); !word.empty(); word = words.next()) {
      found = file_beside(path_, std::string(word));
      if (found.empty()) {
        result_.warnings.push_back(
            fmt::format("its materials \"{}\" are not in its folder; put them there for its colors",
                        word.substr(0, 100)));
      } else {
        read_materials(found, materials_);
      }
    }
  }

  void use_material(const std::string& name) {
    color_.reset();
    image_ = -1;
    const auto material = materials_.find(name);
    if (material == materials_.end()) return;
    color_ = material->second.color;
    const std::string& wanted = material->second.image;
    if (wanted.empty()) return;
    const auto [known, is_new] = images_.try_emplace(wanted, -1);
    if (is_new) {
      const std::string found = file_beside(path_, wanted);
      if (found.empty()) {
        result_.warnings.push_back(
            fmt::format("its image \"{}\" is not in its folder; painted in neutral gray", wanted));
      } else {
        known->second = static_cast<int>(painter_.textures().size());
        painter_.textures().push_back({wanted, found, {}, {}});
      }
    }
    image_ = known->second;
    // The image is the color; Kd beside it is left as a default by most programs.
    color_ = image_ >= 0 ? kWhite : kNeutral;
  }

  void take_uv(Words& words) {
    std::array<double, 2> uv{};
    bool good = parse_number(words.next(), uv[0]);
    const std::string_view v = words.next();
    good = good && (v.empty() || parse_number(v, uv[1])) && std::isfinite(uv[0] + uv[1]);
    uvs_.push_back(good ? Uv{static_cast<float>(uv[0]), static_cast<float>(uv[1])} : Uv{});
  }

  // The image point of a corner "point/uv/normal", or nothing.
  std::optional<Uv> uv_of(std::string_view corner) const {
    const std::size_t slash = corner.find('/');
    if (slash == corner.npos) return std::nullopt;
    corner.remove_prefix(slash + 1);
    std::int64_t index = 0;
    if (!parse_number(corner.substr(0, corner.find('/')), index)) return std::nullopt;
    const auto count = static_cast<std::int64_t>(uvs_.size());
    if (index < 0) index += count + 1;
    if (index < 1 || index > count) return std::nullopt;
    return uvs_[static_cast<std::size_t>(index - 1)];
  }

  void paint_face() {
    const std::size_t triangles = corners_.size() - 2;
    if (corner_uvs_.size() != corners_.size()) {
      painter_.add_plain(triangles, image_ >= 0 ? std::optional(kNeutral) : color_);
      return;
    }
    const Rgb color = color_.value_or(kWhite);
    for (std::size_t i = 2; i < corners_.size(); ++i) {
      painter_.add_textured(image_, {corner_uvs_[0], corner_uvs_[i - 1], corner_uvs_[i]},
                            {color, color, color});
    }
  }

  void finish_colors() {
    // Some programs write 0 to 255 where others write 0 to 1.
    float most = 0;
    for (const FloatRgb& color : point_colors_)
      most = std::max({most, color[0], color[1], color[2]});
    const double full = most > 1 ? 255 : 1;
    if (painter_.textures().empty()) {
      for (std::size_t i = 0; i < colored_points_.size(); ++i) {
        const FloatRgb& c = point_colors_[i];
        painter_.add_sample(
            result_.mesh.points[colored_points_[i]],
            rgb_of(static_cast<double>(c[0]) / full, static_cast<double>(c[1]) / full,
                   static_cast<double>(c[2]) / full));
      }
    }
    result_.paint = painter_.take(result_.mesh);
  }

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
    // A fourth number is a weight, a fourth to sixth are a color: neither moves the point.
    bool odd = false;
    FloatRgb color{};
    std::size_t numbers = 0;
    for (std::string_view word = words.next(); !word.empty(); word = words.next()) {
      double value = 0;
      odd |= !parse_number(word, value) || !std::isfinite(value);
      if (numbers < 3) color[numbers] = static_cast<float>(value);
      ++numbers;
    }
    odd_colors_ += odd && numbers >= 3 ? 1 : 0;
    if (!odd && numbers >= 3) {
      colored_points_.push_back(result_.mesh.points.size());
      point_colors_.push_back(color);
    }
    result_.mesh.points.push_back(point);
  }

  void take_face(Words& words) {
    ++faces_;
    corners_.clear();
    corner_uvs_.clear();
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
      if (const std::optional<Uv> uv = uv_of(word)) corner_uvs_.push_back(*uv);
    }
    if (corners_.size() < 3) {
      throw Error(ErrorKind::kBadInput, face_here(), "has fewer than three corners");
    }
    add_polygon(result_.mesh, corners_);
    paint_face();
  }

  InputFile& file_;
  const std::string& path_;
  MeshFile result_;
  Painter painter_;
  std::map<std::string, Material> materials_;
  std::map<std::string, int> images_;  // by name; -1 is not there
  std::optional<Rgb> color_;           // of the faces to come
  int image_ = -1;
  std::vector<Uv> uvs_;
  std::vector<Uv> corner_uvs_;
  std::vector<std::size_t> colored_points_;
  std::vector<FloatRgb> point_colors_;
  std::vector<int> corners_;
  std::int64_t faces_ = 0;
  std::int64_t highest_ = 0;
  std::string highest_where_;
  std::int64_t odd_colors_ = 0;
};

}  // namespace

MeshFile read_obj(InputFile& file, const std::string& path) { return ObjReader(file, path).read(); }

}  // namespace binderjet
