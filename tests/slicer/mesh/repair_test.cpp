// SPDX-License-Identifier: GPL-3.0-or-later
// What repair leaves alone, what it mends and says, and what it refuses.
#include "slicer/mesh/repair.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <string>

#include "slicer/base/error.h"
#include "slicer/mesh/boundary.h"
#include "tests/slicer/mesh/samples.h"

namespace binderjet {
namespace {

using testing::box;
using ::testing::Contains;
using ::testing::ElementsAre;
using testing::error_of;
using ::testing::HasSubstr;
using testing::inside_out;
using ::testing::IsEmpty;
using testing::joined;

Mesh shuffled(Mesh mesh, unsigned bits) {
  for (Triangle& t : mesh.triangles) {
    if ((bits & 1) != 0) std::swap(t[1], t[2]);
    bits = bits >> 1 | bits << 31;
  }
  return mesh;
}

// Every triangle with points of its own, as a file without shared points has them.
Mesh unwelded(const Mesh& mesh) {
  Mesh result;
  for (const Triangle& t : mesh.triangles) {
    const int first = static_cast<int>(result.points.size());
    for (const int c : t) result.points.push_back(mesh.points[static_cast<std::size_t>(c)]);
    result.triangles.push_back({first, first + 1, first + 2});
  }
  return result;
}

TEST(Boundary, OfABoxWithoutOneTriangleRunsAgainstThatTriangle) {
  Mesh mesh = box();
  EXPECT_THAT(boundary_edges(mesh), IsEmpty());
  mesh.triangles.pop_back();  // 1, 7, 5
  EXPECT_THAT(boundary_edges(mesh),
              ElementsAre(DirectedEdge{1, 5}, DirectedEdge{7, 1}, DirectedEdge{5, 7}));
  EXPECT_EQ(count_edges(mesh).open, 3);
}

TEST(Boundary, CountsAnEdgeThatTwoBoxesShareAsCrowdedButClosed) {
  Mesh mesh = joined(box(), box(1, {1, 1, 0}));
  EXPECT_EQ(count_edges(mesh).crowded, 0);
  // Points 3 and 7 of the first are 0 and 4 of the second.
  for (Triangle& t : mesh.triangles) {
    for (int& c : t) c = c == 8 ? 3 : c == 12 ? 7 : c;
  }
  EXPECT_EQ(count_edges(mesh).crowded, 1);
  EXPECT_EQ(count_edges(mesh).open, 0);
}

TEST(Repair, LeavesOverlappingShellsAndCavitiesExactlyAsTheyAre) {
  const Mesh overlap = joined(box(2, {0.1, 0.2, 0.3}), box(2, {1, 1, 1}));
  const Mesh cavity = joined(box(3), inside_out(box(1, {1, 1, 1})));
  for (const Mesh& mesh : {overlap, cavity}) {
    Mesh copy = mesh;
    const Repair repair = repair_mesh(copy, "x");
    EXPECT_THAT(repair.notes, IsEmpty());
    EXPECT_EQ(copy.points, mesh.points);
    EXPECT_EQ(copy.triangles, mesh.triangles);
  }
}

TEST(Repair, CountsPiecesAndNoCavityAmongThem) {
  Mesh apart = joined(box(), inside_out(box(1, {5, 0, 0})));
  EXPECT_THAT(repair_mesh(apart, "x").remarks, Contains(HasSubstr("2 pieces")));
  Mesh cavity = joined(box(3), inside_out(box(1, {1, 1, 1})));
  EXPECT_THAT(repair_mesh(cavity, "x").remarks, IsEmpty());
}

TEST(Repair, RemarksThatASurfaceGoesThroughItself) {
  Mesh mesh = joined(box(2), box(2, {1, 1, 1}));
  EXPECT_THAT(repair_mesh(mesh, "x").remarks, Contains(HasSubstr("goes through itself")));
  Mesh apart = joined(box(2), box(2, {5, 5, 5}));
  EXPECT_THAT(repair_mesh(apart, "x").remarks, Not(Contains(HasSubstr("goes through itself"))));
}

TEST(Repair, TurnsAPartThatIsInsideOut) {
  Mesh mesh = inside_out(box());
  EXPECT_THAT(repair_mesh(mesh, "x").notes, ElementsAre("turned the part inside in -> out"));
  EXPECT_DOUBLE_EQ(signed_volume(mesh), 1.0);
}

TEST(Repair, DropsFacesThatNameAPointTwice) {
  Mesh mesh = box();
  mesh.triangles.push_back({0, 0, 5});
  EXPECT_THAT(repair_mesh(mesh, "x").notes, ElementsAre("dropped 1 degenerate face"));
  EXPECT_EQ(mesh.triangles.size(), 12u);
}

TEST(Repair, DropsRepeatedFacesWhereTheSurfaceStaysClosed) {
  Mesh mesh = box();
  const auto faces = mesh.triangles;
  mesh.triangles.insert(mesh.triangles.end(), faces.begin(), faces.end());
  EXPECT_THAT(repair_mesh(mesh, "x").notes, ElementsAre("dropped 12 duplicate faces"));
  EXPECT_DOUBLE_EQ(signed_volume(mesh), 1.0);
}

TEST(Repair, GivesASheetAWallOnlyIfToldTo) {
  Mesh sheet = box();
  sheet.triangles.resize(2);  // one side, of area 1
  Mesh copy = sheet;
  EXPECT_THROW(repair_mesh(copy, "x"), Error);
  EXPECT_THAT(repair_mesh(sheet, "x", 0.25).notes, Contains("gave the open surface a wall"));
  EXPECT_EQ(count_edges(sheet).open, 0);
  EXPECT_DOUBLE_EQ(signed_volume(sheet), 0.25);
}

TEST(Repair, MergesPointsOnlyIfThatIsNeeded) {
  Mesh mesh = unwelded(box());
  EXPECT_THAT(repair_mesh(mesh, "x").notes, ElementsAre("merged 28 duplicate points"));
  EXPECT_EQ(mesh.points.size(), 8u);
  EXPECT_TRUE(is_closed(mesh));
}

TEST(Repair, OrientsFacesThatRunAgainstTheirNeighbors) {
  Mesh mesh = shuffled(box(), 0b000100000010);
  EXPECT_THAT(repair_mesh(mesh, "x").notes, ElementsAre("turned 2 faces against their neighbors"));
  EXPECT_DOUBLE_EQ(signed_volume(mesh), 1.0);
}

TEST(Repair, TurnsOneOfTwoShuffledBoxesOutwardButKeepsACavity) {
  // One flipped face makes the file open, so that orientation is looked at at all.
  Mesh apart = joined(shuffled(box(), 1), inside_out(box(1, {5, 0, 0})));
  repair_mesh(apart, "x");
  EXPECT_DOUBLE_EQ(signed_volume(apart), 2.0);
  Mesh hollow = joined(shuffled(box(3), 1), inside_out(box(1, {1, 1, 1})));
  repair_mesh(hollow, "x");
  EXPECT_DOUBLE_EQ(signed_volume(hollow), 26.0);
}

TEST(Repair, ClosesCracksBetweenNearlyEqualPoints) {
  Mesh mesh = unwelded(box(100));
  for (std::size_t i = 0; i < mesh.points.size(); ++i) {
    mesh.points[i][0] += 1e-6 * static_cast<double>(i % 5);
  }
  EXPECT_THAT(repair_mesh(mesh, "x").notes, Contains(HasSubstr("nearly equal points")));
  EXPECT_TRUE(is_closed(mesh));
  EXPECT_NEAR(signed_volume(mesh), 1e6, 1);
}

TEST(Repair, ClosesAHoleAndSaysHowMuchOfTheSurfaceThatIs) {
  Mesh mesh = box();
  mesh.triangles.erase(mesh.triangles.begin() + 2, mesh.triangles.begin() + 4);  // the lid
  EXPECT_THAT(repair_mesh(mesh, "x").notes,
              ElementsAre("closed 1 hole (4 edges, 20 % of the surface)"));
  EXPECT_TRUE(is_closed(mesh));
  EXPECT_DOUBLE_EQ(signed_volume(mesh), 1.0);
}

TEST(Repair, DropsAStrayFaceBesideASolid) {
  Mesh mesh = box();
  mesh.points.insert(mesh.points.end(), {{5, 5, 5}, {6, 5, 5}, {5, 6, 5}});
  mesh.triangles.push_back({8, 9, 10});
  EXPECT_THAT(repair_mesh(mesh, "x").notes, Contains("dropped 2 stray faces"));
  EXPECT_EQ(mesh.triangles.size(), 12u);
}

TEST(Repair, ClosesAPartWithAWallInside) {
  // Two boxes that share a wall: its edges have three faces each.
  Mesh mesh = box();
  mesh.points.insert(mesh.points.end(), {{0.5, 0, 0}, {0.5, 1, 0}, {0.5, 1, 1}, {0.5, 0, 1}});
  mesh.triangles.insert(mesh.triangles.end(), {{8, 9, 10}, {8, 10, 11}});
  repair_mesh(mesh, "x");
  EXPECT_TRUE(is_closed(mesh));
  EXPECT_NEAR(signed_volume(mesh), 1.0, 1e-12);
}

TEST(Repair, RefusesASheetASoupAndADoubledSheet) {
  Mesh sheet;
  sheet.points = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  sheet.triangles = {{0, 1, 2}, {0, 2, 3}};
  EXPECT_THAT(error_of([&] { repair_mesh(sheet, "a.stl"); }),
              HasSubstr("a.stl: is no closed surface: 4 of its edges are open"));
  Mesh doubled = sheet;
  doubled.triangles = {{0, 1, 2}, {0, 2, 3}, {0, 2, 1}, {0, 3, 2}};
  EXPECT_THAT(error_of([&] { repair_mesh(doubled, "a.stl"); }), HasSubstr("encloses no volume"));
}

TEST(Repair, PrintsTwoBoxesWhoseVolumesCancel) {
  Mesh mesh = joined(box(), inside_out(box(1, {5, 0, 0})));
  EXPECT_THAT(repair_mesh(mesh, "x").notes, IsEmpty());
}

RC_GTEST_PROP(Repair, OfABoxWithFlippedAndLostFacesIsThatBox, ()) {
  // Up to two lost triangles leave planar holes of this box or a tent over an edge of it.
  Mesh mesh = shuffled(box(), *rc::gen::arbitrary<unsigned>() & 0xfff);
  mesh.triangles.erase(mesh.triangles.begin() + *rc::gen::inRange(0, 12));
  repair_mesh(mesh, "x");
  RC_ASSERT(is_closed(mesh));
  RC_ASSERT(std::abs(signed_volume(mesh) - 1.0) < 1e-12);
}

}  // namespace
}  // namespace binderjet
