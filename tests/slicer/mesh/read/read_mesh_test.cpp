// SPDX-License-Identifier: GPL-3.0-or-later
// Every format gives the same box, and every fault an error that says where.
#include "slicer/mesh/read/read_mesh.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>
#include <sys/resource.h>

#include <string>
#include <utility>
#include <vector>

#include "slicer/mesh/boundary.h"
#include "tests/slicer/mesh/samples.h"

namespace binderjet {
namespace {

using testing::binary_stl;
using testing::box;
using ::testing::ElementsAre;
using testing::error_of;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::TemporaryFile;

MeshFile read(const std::string& name, std::string_view content) {
  const TemporaryFile file(name, content);
  return read_mesh(file.path());
}

std::string error_reading(const std::string& name, std::string_view content) {
  return error_of([&] { read(name, content); });
}

const std::string kTextStl =
    "solid t\nfacet normal 0 0 0\nouter loop\nvertex 1 0 0\nvertex 0 1 0\nvertex 0 0 1\nendloop\n"
    "endfacet\nfacet normal 0 0 0\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 0 1\nendloop\n"
    "endfacet\nfacet normal 0 0 0\nouter loop\nvertex 0 0 0\nvertex 0 0 1\nvertex 0 1 0\nendloop\n"
    "endfacet\nfacet normal 0 0 0\nouter loop\nvertex 0 0 0\nvertex 0 1 0\nvertex 1 0 0\nendloop\n"
    "endfacet\nendsolid t\n";

std::string with_line_ends(std::string text, const std::string& ending) {
  std::string result;
  for (const char c : text) result += c == '\n' ? ending : std::string(1, c);
  return result;
}

TEST(ReadMesh, WeldsTheTrianglesOfABinaryStl) {
  const MeshFile file = read("box.stl", binary_stl(box()));
  EXPECT_EQ(file.mesh.points.size(), 8u);
  EXPECT_EQ(file.mesh.triangles.size(), 12u);
  EXPECT_TRUE(is_closed(file.mesh));
  EXPECT_DOUBLE_EQ(signed_volume(file.mesh), 1.0);
  EXPECT_FALSE(file.unit_declared);
  EXPECT_EQ(file.unit_mm, 1.0);
  EXPECT_THAT(file.warnings, IsEmpty());
}

TEST(ReadMesh, TellsBinaryStlByItsLengthAndNotByTheWordSolid) {
  const MeshFile file = read("box.stl", binary_stl(box(), "solid facet"));
  EXPECT_EQ(file.mesh.triangles.size(), 12u);
  EXPECT_THAT(file.warnings, ElementsAre(HasSubstr("read as binary")));
}

TEST(ReadMesh, ReadsTextStlWithEveryKindOfLineEnd) {
  for (const std::string ending : {"\n", "\r\n", "\r"}) {
    const MeshFile file = read("t.stl", with_line_ends(kTextStl, ending));
    EXPECT_EQ(file.mesh.points.size(), 4u);
    EXPECT_TRUE(is_closed(file.mesh));
    EXPECT_EQ(file.warnings.size(), ending == "\r" ? 1u : 0u);
  }
}

TEST(ReadMesh, KeepsLinesThatTheBufferCutsAnywhere) {
  // The megabyte of the buffer ends at every place of a line, also between CR and LF.
  for (std::size_t shift = 0; shift < 16; ++shift) {
    std::string text(shift + 1, '#');
    text += "\r\n";
    while (text.size() < (1u << 20) - 60) text += "# filler\r\n";
    for (int i = 0; i < 12; ++i) text += "v " + std::to_string(i) + " 0.125 3\r\n";
    text += "f 1 2 3\r\n";
    const MeshFile file = read("long.obj", text);
    EXPECT_THAT(file.warnings, IsEmpty());
    ASSERT_EQ(file.mesh.points.size(), 12u);
    for (int i = 0; i < 12; ++i) {
      EXPECT_EQ(file.mesh.points[static_cast<std::size_t>(i)], (Point{double(i), 0.125, 3}));
    }
  }
}

TEST(ReadMesh, TakesATextStlThatEndsEarlyOnlyBetweenFacets) {
  EXPECT_THAT(read("t.stl", kTextStl.substr(0, kTextStl.find("endsolid"))).warnings,
              ElementsAre(HasSubstr("endsolid")));
  EXPECT_THAT(error_reading("t.stl", kTextStl.substr(0, kTextStl.size() - 40)),
              HasSubstr("t.stl: line "));
}

TEST(ReadMesh, RefusesAnOpenStlWhoseHeaderDeclaresMore) {
  const std::string whole = binary_stl(box());
  EXPECT_THAT(error_reading("box.stl", whole.substr(0, whole.size() - 100)),
              HasSubstr("declares 12 triangles but is cut off after 10"));
}

TEST(ReadMesh, ReadsPolygonsNegativeIndicesAndLinesOfAnObj) {
  const MeshFile file = read("a.obj",
                             "mtllib x\nv 0 0 0\nv 2 0 0 0.5 nan 1\nv 2 2 0\nv 0 2 \\\n0\n"
                             "vt 0 0\nl 1 2\nusemtl red\nf 1/1 2/1 3/1 4/1\nf -4//1 -2//1 -1//1\n");
  EXPECT_EQ(file.mesh.points.size(), 4u);
  EXPECT_THAT(file.mesh.triangles,
              ElementsAre(Triangle{0, 1, 2}, Triangle{0, 2, 3}, Triangle{0, 2, 3}));
  EXPECT_THAT(file.warnings, ElementsAre(HasSubstr("materials"), HasSubstr("is no number")));
}

TEST(ReadMesh, NamesLineAndFaceOfABadObjIndex) {
  EXPECT_THAT(error_reading("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 1 2 4\n"),
              HasSubstr("a.obj: line 5 (face 2): names point 4"));
  EXPECT_THAT(error_reading("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 0\n"),
              HasSubstr("a.obj: line 4 (face 1)"));
  EXPECT_THAT(error_reading("a.obj", "v 0 0 0\nv 1 0 0\nv 0 inf 0\nf 1 2 3\n"),
              HasSubstr("a.obj: line 3"));
}

TEST(ReadMesh, KeepsDoublesAsTheyAreWritten) {
  const MeshFile file =
      read("a.obj", "v 0.1 1e-320 123456789.123456789\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  EXPECT_EQ(file.mesh.points[0], (Point{0.1, 0.0 + 1e-320, 123456789.123456789}));
}

TEST(ReadMesh, ReadsOffWithColorsAndComments) {
  const MeshFile file = read("a.off",
                             "COFF # a comment\n4 2 0\n0 0 0 1 0 0 1\n1 0 0 1 0 0 1\n1 1 0 1 0 0 "
                             "1\n0 1 0 1 0 0 1\n\n4 0 1 2 3 255 0 0\n3 0 1 2\n");
  EXPECT_EQ(file.mesh.points.size(), 4u);
  EXPECT_EQ(file.mesh.triangles.size(), 3u);
}

TEST(ReadMesh, BelievesNoHeaderThatPromisesMoreThanTheFileHolds) {
  EXPECT_THAT(error_reading("a.off", "OFF\n353535235358 6 0\n0 0 0\n"),
              HasSubstr("declares 353535235358 points"));
  EXPECT_THAT(error_reading("a.ply",
                            "ply\nformat binary_little_endian 1.0\nelement vertex 2000000000\n"
                            "property float x\nproperty float y\nproperty float z\nend_header\n"),
              HasSubstr("declares 2000000000 points"));
  std::string list =
      "ply\nformat binary_little_endian 1.0\nelement face 1\nproperty list uint int "
      "vertex_indices\nend_header\n";
  list += "\xff\xff\xff\xff";
  list += std::string(64, '\0');
  EXPECT_THAT(error_reading("a.ply", list), HasSubstr("declares a list of 4294967295"));
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  EXPECT_LT(usage.ru_maxrss, 1 << 20);  // in KiB
}

TEST(ReadMesh, ReadsPlyOfEitherByteOrderAndAsText) {
  const std::string header =
      " 1.0\nelement vertex 3\nproperty short x\nproperty short y\nproperty uchar red\nproperty "
      "double z\nelement face 1\nproperty list uchar int vertex_index\nend_header\n";
  std::string little = "ply\nformat binary_little_endian" + header;
  std::string big = "ply\nformat binary_big_endian" + header;
  const auto put = [&](auto value) {
    std::string bytes(sizeof value, '\0');
    std::memcpy(bytes.data(), &value, sizeof value);
    little += bytes;
    big += std::string(bytes.rbegin(), bytes.rend());
  };
  for (int i = 0; i < 3; ++i) {
    put(static_cast<std::int16_t>(i * 300));
    put(static_cast<std::int16_t>(-i * i));
    put(std::uint8_t{7});
    put(0.1);
  }
  put(std::uint8_t{3});
  for (const int index : {0, 1, 2}) put(index);
  const std::string text =
      "ply\nformat ascii" + header + "0 0 7 0.1\n300 -1 7 0.1\n600 -4 7 0.1\n3 0 1 2\n";
  for (const std::string& content : {little, big, text}) {
    const MeshFile file = read("a.ply", content);
    EXPECT_THAT(file.mesh.points,
                ElementsAre(Point{0, 0, 0.1}, Point{300, -1, 0.1}, Point{600, -4, 0.1}));
    EXPECT_THAT(file.mesh.triangles, ElementsAre(Triangle{0, 1, 2}));
  }
}

TEST(ReadMesh, RefusesWhatIsNoModel) {
  EXPECT_THAT(error_reading("a.stl", ""), HasSubstr("a.stl: is empty"));
  EXPECT_THAT(error_reading("a.txt", "hello"), HasSubstr("of no known format"));
  EXPECT_THAT(error_reading("a.3mf", "hello"), HasSubstr("not a ZIP"));
  EXPECT_THAT(error_reading("a.3mf", "PK\x03\x04 hello"), HasSubstr("no 3MF file"));
  EXPECT_THAT(error_reading("a.stl", "hello"), HasSubstr("no STL file"));
  EXPECT_THAT(error_reading("a.obj", "v 0 0 0\n"), HasSubstr("has no faces"));
  EXPECT_THAT(error_reading("a.obj", "v 1e30 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"),
              HasSubstr("a.obj: point 1: lies at 1e+30 mm"));
  EXPECT_THAT(error_of([] { read_mesh("/nowhere/a.stl"); }), HasSubstr("No such file"));
}

RC_GTEST_PROP(ReadMesh, EndsInAMeshOrAnErrorForAnyFlippedByte, ()) {
  // One damaged byte anywhere: any answer is right but a crash or an index out of range.
  const std::string ply =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float "
      "z\nelement face 1\nproperty list uchar int vertex_index\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 "
      "0 1 2\n";
  const std::string off = "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
  const std::string obj = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
  const std::vector<std::pair<std::string, std::string>> files = {{"a.ply", ply},
                                                                  {"a.off", off},
                                                                  {"a.obj", obj},
                                                                  {"a.stl", kTextStl},
                                                                  {"b.stl", binary_stl(box())}};
  auto [name, content] = *rc::gen::elementOf(files);
  content[*rc::gen::inRange<std::size_t>(0, content.size())] = *rc::gen::arbitrary<char>();
  const TemporaryFile file(name, content);
  Mesh mesh;
  const std::string error = error_of([&] { mesh = read_mesh(file.path()).mesh; });
  for (const Triangle& t : mesh.triangles) {
    for (const int c : t) RC_ASSERT(c >= 0 && c < static_cast<int>(mesh.points.size()));
  }
  RC_ASSERT(error.empty() != mesh.triangles.empty());
  RC_ASSERT(error.find('\n') == std::string::npos);
}

}  // namespace
}  // namespace binderjet
