// SPDX-License-Identifier: GPL-3.0-or-later
// 3MF and glTF: the transforms on the way to a mesh, units, and what is left out.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "slicer/mesh/boundary.h"
#include "slicer/mesh/read/read_mesh.h"
#include "tests/slicer/mesh/samples.h"
#include "tests/support/scene_files.h"

namespace binderjet {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using testing::error_of;
using ::testing::HasSubstr;
using testing::TemporaryFile;

std::string model_3mf(const std::string& unit, const std::string& resources,
                      const std::string& build) {
  const std::string tetrahedron =
      "<mesh><vertices><vertex x=\"0\" y=\"0\" z=\"0\"/><vertex x=\"1.1\" y=\"0\" z=\"0\"/><vertex "
      "x=\"0\" y=\"2\" z=\"0\"/><vertex x=\"0\" y=\"0\" z=\"3\"/></vertices><triangles><triangle "
      "v1=\"0\" v2=\"2\" v3=\"1\"/><triangle v1=\"0\" v2=\"1\" v3=\"3\"/><triangle v1=\"0\" "
      "v2=\"3\" "
      "v3=\"2\"/><triangle v1=\"1\" v2=\"2\" v3=\"3\"/></triangles></mesh>";
  return package_3mf({.resources = "<object id=\"1\" type=\"model\">" + tetrahedron +
                                   "</object><object id=\"2\" type=\"support\">" + tetrahedron +
                                   "</object>" + resources,
                      .build = build,
                      .unit = unit});
}

MeshFile read_scene(const std::string& name, const std::string& content) {
  const TemporaryFile file(name, content);
  return read_mesh(file.path());
}

TEST(Read3mf, KeepsTheNumbersAndDeclaresTheUnit) {
  const MeshFile file = read_scene("a.3mf", model_3mf("inch", "", "<item objectid=\"1\"/>"));
  EXPECT_TRUE(file.unit_declared);
  EXPECT_EQ(file.unit_mm, 25.4);
  EXPECT_THAT(file.warnings, ElementsAre(HasSubstr("inch")));
  EXPECT_EQ(file.mesh.points[1], (Point{1.1, 0, 0}));  // and not float's 1.10000002
  EXPECT_NEAR(signed_volume(file.mesh), 1.1, 1e-12);
}

TEST(Read3mf, AppliesTheComponentsTransformBeforeTheItems) {
  // The component moves by 10 in x, the item then swaps x and y: 10 in y. A swap mirrors, so the
  // faces turn, or the volume would be negative.
  const MeshFile file = read_scene(
      "a.3mf", model_3mf("millimeter",
                         "<object id=\"3\" type=\"model\"><components><component objectid=\"1\" "
                         "transform=\"1 0 0 0 1 0 0 0 1 10 0 0\"/></components></object>",
                         "<item objectid=\"3\" transform=\"0 1 0 1 0 0 0 0 1 0 0 0\"/>"));
  EXPECT_EQ(file.mesh.points[0], (Point{0, 10, 0}));
  EXPECT_EQ(file.mesh.points[1], (Point{0, 11.1, 0}));
  EXPECT_NEAR(signed_volume(file.mesh), 1.1, 1e-12);
}

TEST(Read3mf, TakesEveryItemOfTheBuildButNoSupports) {
  const MeshFile file = read_scene(
      "a.3mf", model_3mf("millimeter", "",
                         "<item objectid=\"1\"/><item objectid=\"1\" transform=\"1 0 0 0 1 0 0 "
                         "0 1 5 0 0\"/><item objectid=\"2\"/>"));
  EXPECT_EQ(file.mesh.triangles.size(), 8u);
  EXPECT_THAT(file.warnings, ElementsAre(HasSubstr("support")));
}

TEST(Read3mf, RefusesAnEmptyBuild) {
  EXPECT_THAT(error_of([] { read_scene("a.3mf", model_3mf("millimeter", "", "")); }),
              HasSubstr("its build names no model"));
}

// A GLB with one tetrahedron in a node of its own transform.
std::string glb(const std::string& node) {
  const std::string data = raw_bytes<float>({0, 0, 0, 1, 0, 0, 0, 2, 0, 0, 0, 3}) +
                           raw_bytes<std::uint16_t>({0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3});
  const std::string json =
      "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[0]}],\"nodes\":[{" +
      node +
      "\"mesh\":0}],\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"indices\":1}]}]"
      ","
      "\"buffers\":[{\"byteLength\":72}],\"bufferViews\":[{\"buffer\":0,\"byteLength\":48},{"
      "\"buffer\":"
      "0,\"byteOffset\":48,\"byteLength\":24}],\"accessors\":[{\"bufferView\":0,\"componentType\":"
      "5126,"
      "\"count\":4,\"type\":\"VEC3\",\"min\":[0,0,0],\"max\":[1,2,3]},{\"bufferView\":1,"
      "\"componentType\":5123,\"count\":12,\"type\":\"SCALAR\"}]}";
  return glb_file(json, data);
}

TEST(ReadGltf, StandsWhereItsNodePutsItAndWarnsOfMeters) {
  const MeshFile file = read_scene("a.glb", glb("\"translation\":[10,0,0],\"scale\":[2,2,2],"));
  EXPECT_TRUE(is_closed(file.mesh));
  EXPECT_NEAR(signed_volume(file.mesh), 8.0, 1e-9);
  EXPECT_EQ(bounding_box(file.mesh).min[0], 10);
  EXPECT_FALSE(file.unit_declared);
  EXPECT_THAT(file.warnings, Contains(HasSubstr("--units m")));
}

TEST(ReadGltf, TurnsTheFacesOfAMirroringNode) {
  EXPECT_NEAR(signed_volume(read_scene("a.glb", glb("\"scale\":[-1,1,1],")).mesh), 1.0, 1e-9);
}

TEST(ReadGltf, RefusesADamagedFile) {
  EXPECT_THAT(error_of([] { read_scene("a.glb", glb("").substr(0, 200)); }),
              HasSubstr("a.glb: cannot be"));
}

TEST(ReadVrml, RefusesAFaceWhosePointIsNotThere) {
  const std::string coordinates = "{ point [0 0 0, 1 0 0, 0 1 0] }";
  const std::string faces = "{ coordIndex [0, 111111, 2, -1] }";
  EXPECT_THAT(error_of([&] {
                read_scene("a.wrl", "#VRML V1.0 ascii\nSeparator { Coordinate3 " + coordinates +
                                        " IndexedFaceSet " + faces + " }");
              }),
              HasSubstr("a point that is not there"));
  EXPECT_THAT(error_of([&] {
                read_scene("a.wrl",
                           "#VRML V2.0 utf8\nShape { geometry IndexedFaceSet { coord Coordinate " +
                               coordinates + " coordIndex [0, 1, 3, -1] } }");
              }),
              HasSubstr("a point that is not there"));
}

TEST(ReadVrml, RefusesANodeWhereAnotherKindBelongs) {
  const std::string faces =
      "IndexedFaceSet { coord Coordinate { point [0 0 0, 1 0 0, 0 1 0] } coordIndex [0 1 2 -1] ";
  for (const std::string& shape :
       {"appearance " + faces + "}", "geometry " + faces + "normal Material { } }",
        "geometry " + faces + "color Group { } }",
        std::string("geometry PointSet { coord Box { } }"),
        std::string("geometry ElevationGrid { xDimension 2 zDimension 2 height [0 1 0 1] "
                    "texCoord Material { } }")}) {
    EXPECT_THAT(error_of([&] { read_scene("a.wrl", "#VRML V2.0 utf8\nShape { " + shape + " }"); }),
                HasSubstr("where another kind of node belongs"))
        << shape;
  }
}

// Assimp's OBJ reader crashes on files that ours refuses.
TEST(ReadGltf, LeavesToAssimpNothingThatWeReadOurselves) {
  EXPECT_THAT(error_of([] { read_scene("a.obj", "glTF\nv 0 0 0\n"); }),
              HasSubstr("no known format"));
  const std::string obj = "# an OBJ file\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
  EXPECT_THAT(error_of([&] { read_scene("a.gltf", obj); }), HasSubstr("cannot be read"));
  EXPECT_THAT(error_of([&] { read_scene("a.dae", obj); }), HasSubstr("cannot be read"));
}

}  // namespace
}  // namespace binderjet
