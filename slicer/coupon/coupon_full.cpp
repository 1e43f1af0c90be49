// SPDX-License-Identifier: GPL-3.0-or-later
// A coupon on which effects that look alike elsewhere look different.
//
// Slots tell a level from a width, where walls tell them the other way round. Several lengths tell
// a scale from an offset. Flat faces that look up and down, overhangs and pockets tell what sinks
// and what rises from what spreads sideways. Wedges pass through every width and height; pins
// repeat at a pitch that is no multiple of a pixel, so that edges meet the grid everywhere. All
// stands on one plate, so that it is one part.
#include <array>

#include "slicer/coupon/coupon_shapes.h"
#include "slicer/coupon/united.h"

namespace binderjet {
namespace {

constexpr double kSide = 30;
constexpr double kPlate = 0.8;
constexpr double kTop = 4.4;
constexpr double kEdge = 0.7;
constexpr std::array kWidths = {0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 1.0, 1.2, 1.5};

// A block with slots of all widths, 1.2 mm of solid between; `from` and `side` are its corner along
// and across the row.
void add_slots(Mesh& mesh, double from, double side, bool along_y) {
  constexpr double kBar = 1.2;
  constexpr double kDepth = 3;
  double at = from;
  add_turned(mesh, {at, side, kPlate}, {at + kBar, side + kDepth, kTop}, along_y);
  for (const double width : kWidths) {
    at += kBar + width;
    add_turned(mesh, {at, side, kPlate}, {at + kBar, side + kDepth, kTop}, along_y);
  }
}

void add_walls(Mesh& mesh, double from, double side, bool along_y) {
  constexpr double kGap = 1.1;
  constexpr double kDepth = 3;
  double at = from;
  for (const double width : kWidths) {
    add_turned(mesh, {at, side, kPlate}, {at + width, side + kDepth, kTop}, along_y);
    at += width + kGap;
  }
}

// Blocks of 14, 7 and 3 mm, the shorter two in a row beside the long one, each of another height.
void add_lengths(Mesh& mesh, double from, double side, bool along_y) {
  constexpr double kDepth = 1.5;
  constexpr double kNext = 2.7;
  add_turned(mesh, {from, side, kPlate}, {from + 14, side + kDepth, 3.2}, along_y);
  add_turned(mesh, {from, side + kNext, kPlate}, {from + 7, side + kNext + kDepth, 2.1}, along_y);
  add_turned(mesh, {from + 8.5, side + kNext, kPlate}, {from + 11.5, side + kNext + kDepth, 1.5},
             along_y);
}

// A roof over spans of 1, 2 and 4 mm that ends in an overhang of 2 mm.
void add_bridge(Mesh& mesh, double x, double y) {
  constexpr double kDepth = 3;
  constexpr double kLeg = 1;
  constexpr double kRoof = 2.6;
  double at = x;
  for (const double span : {1.0, 2.0, 4.0, 2.0}) {
    add_box(mesh, {at, y, kPlate}, {at + kLeg, y + kDepth, kRoof});
    at += kLeg + span;
  }
  add_box(mesh, {x, y, kRoof}, {at, y + kDepth, 3.6});
}

// Four walls of 1 mm around 3 x 3 mm, with a floor and, if it is closed, a roof.
void add_pocket(Mesh& mesh, double x, double y, bool closed) {
  constexpr double kWall = 1;
  constexpr double kOuter = 5;
  constexpr double kFloor = 1.8;
  constexpr double kRoof = 3.4;
  add_box(mesh, {x, y, kPlate}, {x + kOuter, y + kOuter, kFloor});
  add_box(mesh, {x, y, kFloor}, {x + kOuter, y + kWall, kTop});
  add_box(mesh, {x, y + kOuter - kWall, kFloor}, {x + kOuter, y + kOuter, kTop});
  add_box(mesh, {x, y, kFloor}, {x + kWall, y + kOuter, kTop});
  add_box(mesh, {x + kOuter - kWall, y, kFloor}, {x + kOuter, y + kOuter, kTop});
  if (closed) add_box(mesh, {x, y, kRoof}, {x + kOuter, y + kOuter, kTop});
}

// Slots between floors: windows of 0.1 to 0.5 mm of height between two posts.
void add_windows(Mesh& mesh, double x, double y) {
  constexpr double kWidth = 3;
  constexpr double kDepth = 5;
  constexpr double kPost = 0.7;
  constexpr double kFloor = 0.5;
  add_box(mesh, {x, y, kPlate}, {x + kPost, y + kDepth, kTop});
  add_box(mesh, {x + kWidth - kPost, y, kPlate}, {x + kWidth, y + kDepth, kTop});
  double z = kPlate;
  for (const double window : {0.1, 0.2, 0.3, 0.5}) {
    add_box(mesh, {x, y, z}, {x + kWidth, y + kDepth, z + kFloor});
    z += kFloor + window;
  }
  add_box(mesh, {x, y, z}, {x + kWidth, y + kDepth, kTop});
}

void add_wedges(Mesh& mesh) {
  constexpr double kWall = 3.1 - kPlate;  // height of the walls that taper
  add_prism(mesh, {{{kEdge, 25, kPlate}, {12.7, 25, kPlate}, {12.7, 26.5, kPlate}}}, {0, 0, kWall});
  add_prism(mesh, {{{17.5, 24.4, kPlate}, {17.5, 29.3, kPlate}, {18.7, 29.3, kPlate}}},
            {0, 0, kWall});
  // Ramps, up along x and along y.
  add_prism(mesh, {{{kEdge, 27.6, kPlate}, {12.2, 27.6, kPlate}, {12.2, 27.6, kTop}}}, {0, 1.7, 0});
  add_prism(mesh, {{{19.7, 22.2, kPlate}, {19.7, 29.3, kPlate}, {19.7, 29.3, kTop}}}, {1.5, 0, 0});
}

void add_pins(Mesh& mesh, double x, double y) {
  constexpr double kPin = 0.6;
  constexpr std::array kPitch = {1.37, 1.23};
  for (int j = 0; j < 4; ++j) {
    for (int i = 0; i < 3; ++i) {
      const Point low = {x + i * kPitch[0], y + j * kPitch[1], kPlate};
      add_box(mesh, low, {low[0] + kPin, low[1] + kPin, 2.7});
    }
  }
}

}  // namespace

Mesh full_coupon() {
  Mesh mesh;
  add_box(mesh, {0, 0, 0}, {kSide, kSide, kPlate});
  add_slots(mesh, kEdge, kEdge, false);
  add_walls(mesh, kEdge, 4.9, false);
  add_slots(mesh, kEdge, 26.3, true);
  add_walls(mesh, 9, 22.2, true);
  add_lengths(mesh, kEdge, 9.2, false);
  add_lengths(mesh, 9.2, 16.4, true);
  add_bridge(mesh, kEdge, 14.6);
  add_pocket(mesh, kEdge, 18.8, true);
  add_pocket(mesh, 7, 18.8, false);
  add_windows(mesh, 12.9, 18.8);
  add_wedges(mesh);
  add_pins(mesh, 13.5, 24.7);
  return united(mesh);
}

}  // namespace binderjet
