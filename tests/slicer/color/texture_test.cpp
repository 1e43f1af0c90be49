// SPDX-License-Identifier: GPL-3.0-or-later
// Images on triangles: a checkerboard cube, a missing image, and names that lead elsewhere.
#include <gtest/gtest.h>

#include <cmath>

#include "slicer/base/error.h"
#include "slicer/base/whole_file.h"
#include "slicer/mesh/read/read_mesh.h"
#include "slicer/stack/png.h"
#include "tests/slicer/color/colored_layers.h"

namespace binderjet {
namespace {

constexpr int kSquares = 5;
constexpr double kSideMm = 6;

void write_checkerboard(const std::string& path) {
  constexpr int kTexels = 8;  // per square
  constexpr int kSize = kSquares * kTexels;
  std::vector<std::byte> rgb;
  for (int y = 0; y < kSize; ++y) {
    for (int x = 0; x < kSize; ++x) {
      const bool dark = (x / kTexels + y / kTexels) % 2 == 0;
      for (int c = 0; c < 3; ++c)
        rgb.push_back(std::byte{static_cast<unsigned char>(dark ? 20 : 220)});
    }
  }
  write_file(path, encode_png_rgb(rgb, kSize, kSize, {1, 1}));
}

// A cube whose six faces each carry the whole image.
std::string cube_obj(const std::string& library) {
  std::string text = "mtllib " + library + "\n";
  const Mesh cube = models::box({0, 0, 0}, {kSideMm, kSideMm, kSideMm});
  for (const Point& p : cube.points) {
    text += "v " + std::to_string(p[0]) + " " + std::to_string(p[1]) + " " + std::to_string(p[2]) +
            "\n";
  }
  text += "vt 0 0\nvt 1 0\nvt 0 1\nvt 1 1\nusemtl board\n";
  for (const Triangle& t : cube.triangles) {
    // The two axes that vary over the face are u and v.
    int varies = 0;
    for (const int corner : t) varies |= corner ^ t[0];
    const int u = varies & 1 ? 0 : 1;
    const int v = varies & 4 ? 2 : 1;
    text += "f";
    for (const int corner : t) {
      const int uv = 1 + (corner >> u & 1) + 2 * (corner >> v & 1);
      text += " " + std::to_string(corner + 1) + "/" + std::to_string(uv);
    }
    text += "\n";
  }
  return text;
}

std::shared_ptr<const ColorField> field_of(const std::string& path,
                                           std::vector<std::string>& notes) {
  MeshFile file = read_mesh(path);
  notes = file.warnings;
  return paint_field(std::move(file.paint), {}, notes);
}

TEST(Texture, EdgesOfACheckerboardLieWithinOnePixelOnAllSixFaces) {
  const colored::Folder folder;
  write_checkerboard(folder.file("board.png"));
  folder.write("cube.mtl", "newmtl board\nKd 1 1 1\nmap_Kd board.png\n");
  const std::string path = folder.write("cube.obj", cube_obj("cube.mtl"));
  std::vector<std::string> notes;
  const auto field = field_of(path, notes);
  EXPECT_TRUE(notes.empty());
  const Mesh cube = models::box({0, 0, 0}, {kSideMm, kSideMm, kSideMm});
  const colored::Layers layers = colored::paint(cube, field);
  const auto& size = layers.box.size_px;
  const auto& margin = layers.box.margin_px;
  const std::array<int, 3> last = {size[0] - margin[0] - 1, size[1] - margin[1] - 1, size[2] - 1};
  int compared = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::size_t u = axis == 0 ? 1 : 0;
    const std::size_t v = axis == 2 ? 1 : 2;
    for (const int face : {margin[axis], last[axis]}) {
      for (int i = margin[u]; i <= last[u]; ++i) {
        for (int j = margin[v]; j <= last[v]; ++j) {
          std::array<int, 3> pixel{};
          pixel[axis] = face;
          pixel[u] = i;
          pixel[v] = j;
          const double at_u = (i - margin[u] + 0.5) * layers.grid.pitch_mm[u];
          const double at_v = (j - margin[v] + 0.5) * layers.grid.pitch_mm[v];
          const auto near_line = [](double mm, double pitch) {
            const double square = kSideMm / kSquares;
            return std::abs(mm - square * std::round(mm / square)) < pitch;
          };
          // On the cube's own edges two faces meet in one pixel.
          if (near_line(at_u, layers.grid.pitch_mm[u]) ||
              near_line(at_v, layers.grid.pitch_mm[v])) {
            continue;
          }
          const int row = static_cast<int>(at_v / kSideMm * kSquares);
          const int column = static_cast<int>(at_u / kSideMm * kSquares);
          // The image counts its rows from the top; five rows make that the same color.
          const std::uint8_t want = (row + column) % 2 == 0 ? 20 : 220;
          ASSERT_EQ(layers.at(pixel[0], pixel[1], pixel[2])[0], want)
              << "axis " << axis << " at " << at_u << ", " << at_v;
          ++compared;
        }
      }
    }
  }
  EXPECT_GT(compared, 20000);
}

TEST(Texture, IsNeutralGrayWithAWarningWhereTheImageIsMissing) {
  const colored::Folder folder;
  folder.write("cube.mtl", "newmtl board\nmap_Kd nowhere.png\n");
  std::vector<std::string> notes;
  const auto field = field_of(folder.write("cube.obj", cube_obj("cube.mtl")), notes);
  ASSERT_NE(field, nullptr);
  ASSERT_EQ(notes.size(), 1U);
  EXPECT_NE(notes[0].find("nowhere.png"), std::string::npos);
  EXPECT_EQ(field->slab(0, 1)->at({1, 1, 0}), (FloatRgb{192, 192, 192}));
}

TEST(Texture, IsNeutralGrayWithAWarningWhereTheImageIsDamaged) {
  const colored::Folder folder;
  folder.write("board.png", "\x89PNG\r\n\x1a\nnot really");
  folder.write("cube.mtl", "newmtl board\nmap_Kd board.png\n");
  std::vector<std::string> notes;
  const auto field = field_of(folder.write("cube.obj", cube_obj("cube.mtl")), notes);
  ASSERT_NE(field, nullptr);
  ASSERT_EQ(notes.size(), 1U);
  EXPECT_EQ(field->slab(0, 1)->at({1, 1, 0}), (FloatRgb{192, 192, 192}));
}

TEST(Texture, IsNotReadFromOutsideTheModelsFolder) {
  const colored::Folder outside;
  const colored::Folder folder;
  write_checkerboard(outside.file("board.png"));
  std::filesystem::create_directory(folder.file("model"));
  write_checkerboard(folder.file("board.png"));
  std::filesystem::create_symlink(outside.file("board.png"), folder.file("model/link.png"));
  const std::string model = folder.file("model/cube.obj");
  EXPECT_EQ(file_beside(model, outside.file("board.png")), "");
  EXPECT_EQ(file_beside(model, "../board.png"), "");
  EXPECT_EQ(file_beside(model, "..\\board.png"), "");
  EXPECT_EQ(file_beside(model, "link.png"), "");
  write_checkerboard(folder.file("model/own image.png"));
  EXPECT_EQ(file_beside(model, "own image.png"), folder.file("model/own image.png"));
}

TEST(Texture, AtOneIsTheLastColumnAndRepeatsBeyond) {
  Texture texture{2, 1, {255, 0, 0, 0, 0, 255}, {Tiling::kRepeat, Tiling::kRepeat}};
  const std::array<Uv, 3> one_tile = {{{0, 0}, {1, 0}, {1, 1}}};
  EXPECT_EQ(texture.at({1, 0.5}, one_tile), (Rgb{0, 0, 255}));
  EXPECT_EQ(texture.at({0, 0.5}, one_tile), (Rgb{255, 0, 0}));
  const std::array<Uv, 3> three_tiles = {{{0, 0}, {3, 0}, {3, 1}}};
  EXPECT_EQ(texture.at({1.25, 0.5}, three_tiles), (Rgb{255, 0, 0}));
  EXPECT_EQ(texture.at({2.75, 0.5}, three_tiles), (Rgb{0, 0, 255}));
}

TEST(Texture, HasItsOriginAtTheLowerLeft) {
  const Texture texture{1, 2, {255, 0, 0, 0, 0, 255}, {}};
  const std::array<Uv, 3> corners = {{{0, 0}, {1, 0}, {0, 1}}};
  EXPECT_EQ(texture.at({0.5, 0.25}, corners), (Rgb{0, 0, 255})) << "the row that is stored last";
  EXPECT_EQ(texture.at({0.5, 0.75}, corners), (Rgb{255, 0, 0}));
}

TEST(Texture, LargeImagesAreAveragedDownToTheirShareOfMemory) {
  const colored::Folder folder;
  write_checkerboard(folder.file("board.png"));
  std::vector<std::string> notes;
  const auto textures = load_textures({{"board", folder.file("board.png"), {}, {}}}, notes, 100);
  ASSERT_TRUE(textures[0].has_value());
  EXPECT_EQ(textures[0]->width, 10);
  EXPECT_EQ(textures[0]->height, 10);
  EXPECT_EQ(textures[0]->rgb[0], 20);
}

}  // namespace
}  // namespace binderjet
