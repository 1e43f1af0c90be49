// SPDX-License-Identifier: GPL-3.0-or-later
// Images that lie within a model's own file, in each format that exporters use.
#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>
#include <gtest/gtest.h>

#include <cmath>

#include "slicer/mesh/read/read_mesh.h"
#include "tests/slicer/color/colored_layers.h"
#include "tests/support/scene_files.h"

namespace binderjet {
namespace {

// Red at the upper left, green at the upper right, blue below on the left, white on the right.
std::string image_bytes(const std::string& format) {
  constexpr int kSize = 64;
  OIIO::ImageBuf image(OIIO::ImageSpec(kSize, kSize, 3, OIIO::TypeDesc::UINT8));
  const auto fill = [&](int x, int y, std::array<float, 3> color) {
    constexpr int kHalf = kSize / 2;
    OIIO::ImageBufAlgo::fill(image, color, OIIO::ROI(x, x + kHalf, y, y + kHalf));
  };
  fill(0, 0, {1, 0, 0});
  fill(kSize / 2, 0, {0, 1, 0});
  fill(0, kSize / 2, {0, 0, 1});
  fill(kSize / 2, kSize / 2, {1, 1, 1});
  const colored::Folder folder;
  const std::string path = folder.file("image." + format);
  EXPECT_TRUE(image.write(path)) << image.geterror();
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

// The model is a square of 1 mm in x and y that carries the whole image.
void expect_the_image(const std::string& path) {
  MeshFile file = read_mesh(path);
  std::vector<std::string> notes = file.warnings;
  const auto field = paint_field(std::move(file.paint), {}, notes);
  for (const std::string& note : notes) EXPECT_EQ(note.find("image"), std::string::npos) << note;
  ASSERT_NE(field, nullptr);
  const auto near = [&](double x, double y, FloatRgb want) {
    const FloatRgb color = field->slab(-0.1, 0.1)->at({x, y, 0});
    for (std::size_t c = 0; c < 3; ++c) {
      EXPECT_NEAR(color[c], want[c], 6) << x << ", " << y << ", channel " << c;
    }
  };
  near(0.25, 0.75, {255, 0, 0});
  near(0.75, 0.75, {0, 255, 0});
  near(0.25, 0.25, {0, 0, 255});
  near(0.75, 0.25, {255, 255, 255});
}

std::string square_glb(const std::string& image, const std::string& mime) {
  std::string data = raw_bytes<float>({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0});
  data += raw_bytes<float>({0, 1, 1, 1, 1, 0, 0, 0});  // glTF counts v from the top
  data += raw_bytes<std::uint16_t>({0, 1, 2, 0, 2, 3});
  data += image;
  const std::string json = R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],
    "nodes":[{"mesh":0}],"meshes":[{"primitives":[{"attributes":{"POSITION":0,"TEXCOORD_0":1},
    "indices":2,"material":0}]}],"materials":[{"pbrMetallicRoughness":{"baseColorTexture":
    {"index":0}}}],"textures":[{"source":0}],"images":[{"bufferView":3,"mimeType":")" +
                           mime + R"("}],"buffers":[{"byteLength":)" + std::to_string(data.size()) +
                           R"(}],"bufferViews":[{"buffer":0,"byteLength":48},
    {"buffer":0,"byteOffset":48,"byteLength":32},{"buffer":0,"byteOffset":80,"byteLength":12},
    {"buffer":0,"byteOffset":92,"byteLength":)" +
                           std::to_string(image.size()) + R"(}],"accessors":[
    {"bufferView":0,"componentType":5126,"count":4,"type":"VEC3","min":[0,0,0],"max":[1,1,0]},
    {"bufferView":1,"componentType":5126,"count":4,"type":"VEC2"},
    {"bufferView":2,"componentType":5123,"count":6,"type":"SCALAR"}]})";
  return glb_file(json, data);
}

std::string square_3mf(const std::string& image, const std::string& extension,
                       const std::string& mime) {
  const std::string place = "/3D/Textures/image." + extension;
  return package_3mf(
      {.resources = "<m:texture2d id=\"5\" path=\"" + place + "\" contenttype=\"" + mime + R"("/>
      <m:texture2dgroup id="6" texid="5"><m:tex2coord u="0" v="0"/><m:tex2coord u="1" v="0"/>
      <m:tex2coord u="1" v="1"/><m:tex2coord u="0" v="1"/></m:texture2dgroup>
      <object id="1" type="model"><mesh><vertices><vertex x="0" y="0" z="0"/>
      <vertex x="1" y="0" z="0"/><vertex x="1" y="1" z="0"/><vertex x="0" y="1" z="0"/>
      <vertex x="0.5" y="0.5" z="-1"/></vertices><triangles>
      <triangle v1="0" v2="1" v3="2" pid="6" p1="0" p2="1" p3="2"/>
      <triangle v1="0" v2="2" v3="3" pid="6" p1="0" p2="2" p3="3"/>
      <triangle v1="1" v2="0" v3="4"/><triangle v1="2" v2="1" v3="4"/>
      <triangle v1="3" v2="2" v3="4"/><triangle v1="0" v2="3" v3="4"/></triangles></mesh></object>)",
       .build = "<item objectid=\"1\"/>",
       .image = place,
       .image_bytes = image});
}

TEST(ImageWithin, AGlbMayBeInAnyFormatThatExportersUse) {
  const colored::Folder folder;
  for (const char* format : {"png", "jpg", "webp", "bmp"}) {
    SCOPED_TRACE(format);
    const std::string kind = format;
    const std::string mime = "image/" + (kind == "jpg" ? "jpeg" : kind);
    expect_the_image(folder.write(kind + ".glb", square_glb(image_bytes(kind), mime)));
  }
}

TEST(ImageWithin, A3mfIsPngOrJpeg) {
  const colored::Folder folder;
  expect_the_image(folder.write("png.3mf", square_3mf(image_bytes("png"), "png", "image/png")));
  expect_the_image(folder.write("jpg.3mf", square_3mf(image_bytes("jpg"), "jpg", "image/jpeg")));
}

TEST(ImageWithin, IsNeutralGrayWithAWarningWhereItIsDamaged) {
  const colored::Folder folder;
  const std::string path =
      folder.write("a.glb", square_glb(image_bytes("png").substr(0, 60), "image/png"));
  MeshFile file = read_mesh(path);
  std::vector<std::string> notes = file.warnings;
  const auto field = paint_field(std::move(file.paint), {}, notes);
  ASSERT_NE(field, nullptr);
  EXPECT_NE(notes.back().find("gray"), std::string::npos) << notes.back();
  EXPECT_EQ(field->slab(-0.1, 0.1)->at({0.5, 0.5, 0}), (FloatRgb{192, 192, 192}));
}

}  // namespace
}  // namespace binderjet
