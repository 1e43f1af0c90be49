// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/mesh/paint.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>

namespace binderjet {
namespace {

constexpr std::array<Rgb, 3> kWhiteCorners = {kWhite, kWhite, kWhite};

// The color of each point if all corners there agree.
std::optional<std::vector<Rgb>> colors_of_points(const Mesh& mesh,
                                                 const std::vector<std::array<Rgb, 3>>& corners,
                                                 std::vector<bool>& known) {
  std::vector<Rgb> colors(mesh.points.size());
  known.assign(mesh.points.size(), false);
  for (std::size_t t = 0; t < corners.size(); ++t) {
    for (std::size_t c = 0; c < 3; ++c) {
      const auto point = static_cast<std::size_t>(mesh.triangles[t][c]);
      if (known[point] && colors[point] != corners[t][c]) return std::nullopt;
      known[point] = true;
      colors[point] = corners[t][c];
    }
  }
  return colors;
}

}  // namespace

void Painter::begin_colors() {
  paint_.corners.insert(paint_.corners.end(), bare_, kWhiteCorners);
  bare_ = 0;
}

void Painter::pad_images() {
  if (paint_.images.empty()) return;
  paint_.images.resize(paint_.corners.size(), -1);
  paint_.uvs.resize(paint_.corners.size());
}

void Painter::add_plain(std::size_t count, const std::optional<Rgb>& color) {
  if (!color && paint_.corners.empty()) {
    bare_ += count;
    return;
  }
  begin_colors();
  colored_ |= count > 0 && color.has_value();
  const Rgb c = color.value_or(kWhite);
  paint_.corners.insert(paint_.corners.end(), count, {c, c, c});
  pad_images();
}

void Painter::add_corners(const std::array<Rgb, 3>& corners) {
  begin_colors();
  colored_ = true;
  varies_ |= corners[0] != corners[1] || corners[1] != corners[2];
  paint_.corners.push_back(corners);
  pad_images();
}

void Painter::add_textured(int image, const std::array<Uv, 3>& uvs,
                           const std::array<Rgb, 3>& corners) {
  begin_colors();
  colored_ |= image >= 0 || corners != kWhiteCorners;
  if (paint_.images.empty()) {
    paint_.images.assign(paint_.corners.size(), -1);
    paint_.uvs.resize(paint_.corners.size());
  }
  paint_.corners.push_back(corners);
  paint_.images.push_back(image);
  paint_.uvs.push_back(uvs);
}

Paint Painter::take(const Mesh& mesh, bool by_vertex) {
  Paint paint = std::move(paint_);
  paint_ = {};
  if (!paint.samples.empty()) {
    Paint samples;
    samples.samples = std::move(paint.samples);
    samples.sample_colors = std::move(paint.sample_colors);
    return samples;
  }
  if (paint.corners.size() != mesh.triangles.size()) return {};
  if (by_vertex && varies_ && paint.images.empty()) {
    std::vector<bool> known;
    if (const auto colors = colors_of_points(mesh, paint.corners, known)) {
      Paint samples;
      for (std::size_t i = 0; i < mesh.points.size(); ++i) {
        if (!known[i]) continue;
        samples.samples.push_back(mesh.points[i]);
        samples.sample_colors.push_back((*colors)[i]);
      }
      return samples;
    }
  }
  if (!colored_ && paint.uvs.empty()) return {};
  if (std::all_of(paint.corners.begin(), paint.corners.end(),
                  [](const auto& corners) { return corners == kWhiteCorners; })) {
    paint.corners = {};
  }
  paint.points = mesh.points;
  paint.triangles = mesh.triangles;
  return paint;
}

Rgb rgb_of(double red, double green, double blue) {
  const auto byte = [](double value) {
    return static_cast<std::uint8_t>(std::lround(255 * std::clamp(value, 0.0, 1.0)));
  };
  return {byte(red), byte(green), byte(blue)};
}

std::string file_beside(const std::string& model_path, std::string name) {
  namespace fs = std::filesystem;
  // Programs on Windows write its separators; there they never are part of a name.
  std::replace(name.begin(), name.end(), '\\', '/');
  const fs::path relative(name);
  if (name.empty() || relative.is_absolute() || name.find(':') != name.npos) return {};
  fs::path place = fs::path(model_path).parent_path();
  std::error_code error;
  for (const fs::path& step : relative) {
    if (step == "..") return {};
    place /= step;
    if (fs::is_symlink(fs::symlink_status(place, error))) return {};
  }
  return fs::is_regular_file(place, error) ? place.string() : std::string();
}

}  // namespace binderjet
