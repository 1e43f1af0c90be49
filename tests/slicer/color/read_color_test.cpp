// SPDX-License-Identifier: GPL-3.0-or-later
// Colors as files of every format carry them.
#include <gtest/gtest.h>

#include <array>
#include <cstring>
#include <set>

#include "slicer/base/error.h"
#include "slicer/mesh/read/read_mesh.h"
#include "tests/slicer/color/colored_layers.h"

namespace binderjet {
namespace {

constexpr const char* kFaces = "3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n";

std::set<Rgb> sample_colors(const Paint& paint) {
  return {paint.sample_colors.begin(), paint.sample_colors.end()};
}
std::set<Rgb> corner_colors(const Paint& paint) {
  std::set<Rgb> colors;
  for (const auto& corners : paint.corners) colors.insert(corners.begin(), corners.end());
  return colors;
}

TEST(ReadColor, ObjPointsMayCountToOneOrTo255) {
  const colored::Folder folder;
  const std::string faces = "f 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
  const std::set<Rgb> want = {{255, 0, 0}, {0, 255, 0}, {0, 0, 255}, {51, 102, 153}};
  for (const std::string& points :
       {std::string("v 0 0 0 1 0 0\nv 1 0 0 0 1 0\nv 0 1 0 0 0 1\nv 0 0 1 0.2 0.4 0.6\n"),
        std::string("v 0 0 0 255 0 0\nv 1 0 0 0 255 0\nv 0 1 0 0 0 255\nv 0 0 1 51 102 153\n")}) {
    EXPECT_EQ(sample_colors(read_mesh(folder.write("a.obj", points + faces)).paint), want);
  }
}

TEST(ReadColor, ObjWithoutColorsHasNone) {
  const colored::Folder folder;
  const std::string path = folder.write(
      "a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
  EXPECT_TRUE(read_mesh(path).paint.empty());
}

TEST(ReadColor, ObjMaterialsPaintFaces) {
  const colored::Folder folder;
  folder.write("m.mtl", "newmtl red one\nKd 1 0 0\nnewmtl blue\nKd 0 0 1\n");
  const std::string path = folder.write(
      "a.obj",
      "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nusemtl red one\nf 1 3 2\nf 1 2 4\n"
      "usemtl blue\nf 1 4 3\nf 2 3 4\n");
  const Paint paint = read_mesh(path).paint;
  ASSERT_EQ(paint.corners.size(), 4U);
  EXPECT_EQ(paint.corners[1][0], (Rgb{255, 0, 0}));
  EXPECT_EQ(paint.corners[2][0], (Rgb{0, 0, 255}));
}

TEST(ReadColor, OffHasColorsOfPointsOrOfFaces) {
  const colored::Folder folder;
  const std::string points =
      "COFF\n4 4 0\n0 0 0 255 0 0 255\n1 0 0 0 255 0 255\n0 1 0 0 0 255 255\n0 0 1 9 8 7 255\n";
  EXPECT_EQ(sample_colors(read_mesh(folder.write("a.off", points + kFaces)).paint),
            (std::set<Rgb>{{255, 0, 0}, {0, 255, 0}, {0, 0, 255}, {9, 8, 7}}));
  const std::string faces =
      "OFF\n4 4 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1 255 0 0\n3 0 1 3 0.0 1.0 0.0\n3 0 3 2\n"
      "3 1 2 3 1 2 3\n";
  const Paint paint = read_mesh(folder.write("b.off", faces)).paint;
  ASSERT_EQ(paint.corners.size(), 4U);
  EXPECT_EQ(paint.corners[0][0], (Rgb{255, 0, 0}));
  EXPECT_EQ(paint.corners[1][0], (Rgb{0, 255, 0}));
  EXPECT_EQ(paint.corners[2][0], kWhite);
  EXPECT_EQ(paint.corners[3][0], (Rgb{1, 2, 3}));
}

TEST(ReadColor, PlyHasColorsOfPointsOrOfFaces) {
  const colored::Folder folder;
  const std::string points =
      "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
      "property float z\nproperty uchar red\nproperty uchar green\nproperty uchar blue\n"
      "element face 4\nproperty list uchar int vertex_indices\nend_header\n"
      "0 0 0 255 0 0\n1 0 0 0 255 0\n0 1 0 0 0 255\n0 0 1 9 8 7\n";
  EXPECT_EQ(sample_colors(read_mesh(folder.write("a.ply", points + kFaces)).paint),
            (std::set<Rgb>{{255, 0, 0}, {0, 255, 0}, {0, 0, 255}, {9, 8, 7}}));
  const std::string faces =
      "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
      "property float z\nelement face 4\nproperty list uchar int vertex_indices\n"
      "property uchar red\nproperty uchar green\nproperty uchar blue\nend_header\n"
      "0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1 1 2 3\n3 0 1 3 4 5 6\n3 0 3 2 7 8 9\n3 1 2 3 10 11 12\n";
  const Paint paint = read_mesh(folder.write("b.ply", faces)).paint;
  ASSERT_EQ(paint.corners.size(), 4U);
  EXPECT_EQ(paint.corners[2][1], (Rgb{7, 8, 9}));
}

// A binary STL of a tetrahedron with these attribute bytes.
std::string stl(const std::string& header, const std::array<std::uint16_t, 4>& bits) {
  std::string text = header;
  text.resize(80, ' ');
  const std::uint32_t count = 4;
  text.append(reinterpret_cast<const char*>(&count), 4);
  const std::array<std::array<float, 3>, 4> points = {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  const std::array<std::array<std::size_t, 3>, 4> faces = {
      {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};
  for (std::size_t f = 0; f < 4; ++f) {
    text.append(12, '\0');
    for (const std::size_t corner : faces[f]) {
      text.append(reinterpret_cast<const char*>(points[corner].data()), 12);
    }
    text.append(reinterpret_cast<const char*>(&bits[f]), 2);
  }
  return text;
}

TEST(ReadColor, StlSpeaksBothDialects) {
  const colored::Folder folder;
  // VisCAM: bit 15 is set where there is a color, blue lowest.
  Paint paint =
      read_mesh(folder.write("v.stl", stl("viscam", {0x801f, 0xfc00, 0x83e0, 0x001f}))).paint;
  ASSERT_EQ(paint.corners.size(), 4U);
  EXPECT_EQ(paint.corners[0][0], (Rgb{0, 0, 255}));
  EXPECT_EQ(paint.corners[1][0], (Rgb{255, 0, 0}));
  EXPECT_EQ(paint.corners[2][0], (Rgb{0, 255, 0}));
  EXPECT_EQ(paint.corners[3][0], kWhite);
  // Magics: the part's color in the header, bit 15 clear is a color of the facet's own, red lowest.
  paint = read_mesh(folder.write("m.stl",
                                 stl("x COLOR=\x0a\x14\x1e\xff", {0x001f, 0x7c00, 0x8000, 0xffff})))
              .paint;
  ASSERT_EQ(paint.corners.size(), 4U);
  EXPECT_EQ(paint.corners[0][0], (Rgb{255, 0, 0}));
  EXPECT_EQ(paint.corners[1][0], (Rgb{0, 0, 255}));
  EXPECT_EQ(paint.corners[2][0], (Rgb{10, 20, 30}));
  EXPECT_EQ(paint.corners[3][0], (Rgb{10, 20, 30}));
  EXPECT_TRUE(read_mesh(folder.write("n.stl", stl("none", {0, 0, 0, 0}))).paint.empty());
}

TEST(ReadColor, Vrml2MaterialsAndTransformsMatter) {
  const colored::Folder folder;
  const std::string shape =
      "Shape { appearance Appearance { material Material { diffuseColor 1 0 0 } }\n"
      "geometry IndexedFaceSet { coord Coordinate { point [0 0 0, 1 0 0, 0 1 0, 0 0 1] }\n"
      "coordIndex [0 2 1 -1 0 1 3 -1 0 3 2 -1 1 2 3 -1] } }\n";
  const MeshFile file = read_mesh(folder.write(
      "a.wrl",
      "#VRML V2.0 utf8\nTransform { translation 5 0 0 scale 2 2 2 children [ " + shape + "] }\n"));
  EXPECT_EQ(file.mesh.triangles.size(), 4U);
  EXPECT_EQ(bounding_box(file.mesh).min, (Point{5, 0, 0}));
  EXPECT_EQ(bounding_box(file.mesh).max, (Point{7, 2, 2}));
  EXPECT_EQ(corner_colors(file.paint), (std::set<Rgb>{{255, 0, 0}}));
}

TEST(ReadColor, VrmlThatTakesInOtherFilesIsRefused) {
  const colored::Folder folder;
  folder.write("b.iv", "#Inventor V2.1 ascii\nCube {}\n");
  const std::string path = folder.write("a.wrl", "#VRML V1.0 ascii\nFile { name \"b.iv\" }\n");
  EXPECT_THROW(read_mesh(path), Error);
  EXPECT_THROW(read_mesh(folder.write("c.wrl", "#VRML V2.0 utf8\nShape { nonsense")), Error);
}

struct Expected {
  const char* file;
  std::size_t samples;
  std::size_t triangles;
  std::size_t images;
  std::vector<Rgb> colors;  // all of these are there
};

TEST(ReadColor, EveryColoredModelOfTheDataFolderHasItsColors) {
  const char* given = std::getenv("BINDERJET_DATA");
  const std::filesystem::path data =
      given != nullptr ? given : std::filesystem::path(BINDERJET_SOURCE_DIR) / "../shared/data";
  const std::filesystem::path folder = data / "models/colour";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no colored models at " << folder;
  const std::vector<Expected> table = {
      {"fuze/fuze.obj", 0, 1000, 1, {}},
      {"spot/spot_triangulated.obj", 0, 5856, 0, {}},
      {"scallop.glb", 60002, 0, 0, {}},
      {"dodeca_chain_loop_color.3mf",
       0,
       7680,
       0,
       {{255, 0, 128}, {128, 128, 255}, {0, 255, 6}, {128, 64, 0}, {252, 221, 3}, {0, 255, 255}}},
      {"sphere_logo.3mf", 0, 3032, 1, {}},
      {"pyramid_vertexcolor.3mf", 4, 0, 0, {{255, 0, 0}, {0, 0, 255}, {0, 255, 0}, kWhite}},
      {"sextant.wrl", 0, 3920, 0, {{255, 255, 0}, {255, 0, 0}, {0, 255, 0}, {0, 0, 255}}},
      {"vrml1_material_per_face_vertex.wrl", 24, 0, 0, {{255, 0, 0}, {0, 255, 255}, {0, 255, 0}}},
      {"reference.ply", 845, 0, 0, {}},
      {"reference.obj", 0, 0, 0, {}},
  };
  for (const Expected& want : table) {
    SCOPED_TRACE(want.file);
    const Paint paint = read_mesh((folder / want.file).string()).paint;
    EXPECT_FALSE(paint.empty());
    const std::size_t samples = want.samples > 0 ? want.samples : paint.samples.size();
    EXPECT_EQ(paint.samples.size(), samples);
    EXPECT_EQ(paint.triangles.size(), want.triangles);
    EXPECT_EQ(paint.textures.size(), want.images);
    std::set<Rgb> colors = sample_colors(paint);
    colors.merge(corner_colors(paint));
    for (const Rgb& color : want.colors) {
      EXPECT_TRUE(colors.contains(color))
          << int{color[0]} << ' ' << int{color[1]} << ' ' << int{color[2]};
    }
  }
}

}  // namespace
}  // namespace binderjet
