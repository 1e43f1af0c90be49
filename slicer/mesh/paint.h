// SPDX-License-Identifier: GPL-3.0-or-later
// The color of a model's surface as its file gives it: colored points, or painted triangles.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "slicer/mesh/mesh.h"

namespace binderjet {

// Red, green, blue as the file's numbers stand, 255 is full. No transfer curve is applied: what a
// file calls (128, 0, 0) is sent as (128, 0, 0).
using Rgb = std::array<std::uint8_t, 3>;
using FloatRgb = std::array<float, 3>;  // the same scale, for sums

inline constexpr Rgb kWhite = {255, 255, 255};    // paper: no ink
inline constexpr Rgb kNeutral = {192, 192, 192};  // where a texture should be and is not

using Uv = std::array<float, 2>;  // (0, 0) is the image's lower left corner, (1, 1) its upper right

enum class Tiling : std::uint8_t { kRepeat, kMirror, kClamp };

// An image that triangles refer to; it is decoded when the part is painted, not while it is read.
struct TextureSource {
  std::string name;              // for messages
  std::string path;              // the file, or empty:
  std::vector<std::byte> bytes;  // the file's bytes
  std::array<Tiling, 2> tiling{};
};

// Either `samples`: the surface's color is known at points, as at the vertices of a scan. Or
// `triangles`: each has a color per corner and perhaps an image. Both empty: no color.
struct Paint {
  std::vector<Point> samples;
  std::vector<Rgb> sample_colors;

  std::vector<Point> points;  // of the triangles
  std::vector<Triangle> triangles;
  std::vector<std::array<Rgb, 3>> corners;  // per triangle; multiplies its image. Empty: white
  std::vector<int> images;                  // per triangle, -1 without; empty if no triangle has
  std::vector<std::array<Uv, 3>> uvs;       // per triangle; as long as `images`
  std::vector<TextureSource> textures;

  // Texture coordinates without an image, for a user who names one.
  bool has_loose_uvs() const { return !uvs.empty() && textures.empty(); }
  bool empty() const { return samples.empty() && triangles.empty(); }
};

// What a reader collects while triangles come in: paint for each, in their order.
class Painter {
 public:
  // Paint of the next `count` triangles that share a color and have no image.
  void add_plain(std::size_t count, const std::optional<Rgb>& color);
  void add_corners(const std::array<Rgb, 3>& corners);
  void add_textured(int image, const std::array<Uv, 3>& uvs, const std::array<Rgb, 3>& corners);

  std::vector<TextureSource>& textures() { return paint_.textures; }
  // A colored vertex of a surface whose vertices carry the color.
  void add_sample(const Point& point, const Rgb& color) {
    paint_.samples.push_back(point);
    paint_.sample_colors.push_back(color);
  }
  bool has_samples() const { return !paint_.samples.empty(); }

  // The paint of `mesh`, whose triangles are those that were added. Samples win over triangles.
  // Without any color it is empty. With `by_vertex`, corner colors that vary inside triangles
  // and agree at every point become samples.
  Paint take(const Mesh& mesh, bool by_vertex = false);

 private:
  void begin_colors();
  void pad_images();

  Paint paint_;
  std::size_t bare_ = 0;  // triangles before the first color: most models never get there
  bool colored_ = false;
  bool varies_ = false;
};

Rgb rgb_of(double red, double green, double blue);  // 0 to 1 each, clamped, to the nearest of 255

// The file that a model means by `name`, in its own folder or below. Empty if there is none, or if
// the name leads out of the folder: absolute, through "..", or through a link.
std::string file_beside(const std::string& model_path, std::string name);

}  // namespace binderjet
