// SPDX-License-Identifier: GPL-3.0-or-later
#include "slicer/coupon/coupon.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <numbers>

#include "slicer/base/whole_file.h"
#include "slicer/coupon/coupon_shapes.h"
#include "slicer/coupon/united.h"

namespace binderjet {
namespace {

Point scaled(const Point& a, double s) { return {a[0] * s, a[1] * s, a[2] * s}; }
double dot(const Point& a, const Point& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Point unit(const Point& a) { return scaled(a, 1 / std::sqrt(dot(a, a))); }

Mesh slots() {
  constexpr double kBar = 2;    // solid between two slots
  constexpr double kDepth = 6;  // length of a slot
  constexpr double kHeight = 4;
  constexpr double kBottom = 1;  // solid below the slots, so that the block stays one piece
  constexpr double kGap = 2;
  Mesh mesh;
  for (const bool along_y : {false, true}) {
    const double side = along_y ? -kGap - kDepth : 0;
    double x = 0;
    for (int tenth = 1; tenth <= 11; ++tenth) {
      add_turned(mesh, {x, side, 0}, {x + kBar, side + kDepth, kHeight}, along_y);
      x += kBar + (tenth <= 10 ? tenth / 10.0 : 0);
    }
    add_turned(mesh, {0, side, 0}, {x, side + kDepth, kBottom}, along_y);
  }
  add_box(mesh, {-kGap, 0, 0}, {0, kDepth, kBottom});  // what holds the two blocks together
  return united(mesh);
}

Mesh walls() {
  constexpr double kLength = 8;
  constexpr double kHeight = 4;
  constexpr double kPlate = 1;
  constexpr double kGap = 2;
  Mesh mesh;
  for (const bool along_y : {false, true}) {
    const double side = along_y ? -kGap - kLength : 0;
    double x = kGap;
    for (int tenth = 1; tenth <= 15; ++tenth) {
      add_turned(mesh, {x, side, 0}, {x + tenth / 10.0, side + kLength, kHeight}, along_y);
      x += tenth / 10.0 + kGap;
    }
    add_turned(mesh, {0, side, 0}, {x, side + kLength, kPlate}, along_y);
  }
  add_box(mesh, {-kGap, 0, 0}, {0, kLength, kPlate});  // what holds the two plates together
  return united(mesh);
}

// A unit ball of 20 * 4^rounds triangles, cut from an icosahedron.
Mesh unit_ball(int rounds) {
  const double golden = std::numbers::phi;
  Mesh mesh;
  for (const double a : {-1.0, 1.0}) {
    for (const double b : {-golden, golden}) {
      for (const Point& p : {Point{0, a, b}, Point{a, b, 0}, Point{b, 0, a}}) {
        mesh.points.push_back(unit(p));
      }
    }
  }
  // The faces are the triples of corners that are neighbors of each other.
  const auto neighbors = [&](int a, int b) {
    return dot(mesh.points[static_cast<std::size_t>(a)], mesh.points[static_cast<std::size_t>(b)]) >
           0.4;
  };
  for (int a = 0; a < 12; ++a) {
    for (int b = a + 1; b < 12; ++b) {
      for (int c = b + 1; c < 12; ++c) {
        if (!neighbors(a, b) || !neighbors(b, c) || !neighbors(a, c)) continue;
        const Point& p = mesh.points[static_cast<std::size_t>(a)];
        const Point& q = mesh.points[static_cast<std::size_t>(b)];
        const Point& r = mesh.points[static_cast<std::size_t>(c)];
        const Point cross = {q[1] * r[2] - q[2] * r[1], q[2] * r[0] - q[0] * r[2],
                             q[0] * r[1] - q[1] * r[0]};
        mesh.triangles.push_back(dot(p, cross) > 0 ? Triangle{a, b, c} : Triangle{a, c, b});
      }
    }
  }
  for (int round = 0; round < rounds; ++round) split_unit_ball(mesh);
  return mesh;
}

Mesh golf_ball() {
  constexpr double kRadius = 42.7 / 2;  // the smallest that the rules of golf allow
  constexpr int kDimples = 336;
  constexpr double kDimpleAngle = 0.095;
  constexpr double kDimpleDepth = 0.25;
  constexpr int kRounds = 7;
  // Centers on a golden spiral lie about as far apart as so many can.
  const double turn = 2 * std::numbers::pi * (2 - std::numbers::phi);
  std::vector<Point> centers;
  for (int i = 0; i < kDimples; ++i) {
    const double z = 1 - (2 * i + 1.0) / kDimples;
    const double r = std::sqrt(1 - z * z);
    centers.push_back({r * std::cos(i * turn), r * std::sin(i * turn), z});
  }
  Mesh mesh = unit_ball(kRounds);
  for (Point& point : mesh.points) {
    // The centers are sorted by z, falling; only those within a dimple's height matter.
    const auto first =
        std::lower_bound(centers.begin(), centers.end(), point[2] + kDimpleAngle,
                         [](const Point& center, double z) { return center[2] > z; });
    double nearest = 0;
    for (auto c = first; c != centers.end() && (*c)[2] >= point[2] - kDimpleAngle; ++c) {
      nearest = std::max(nearest, dot(*c, point));
    }
    const double t = std::acos(std::min(nearest, 1.0)) / kDimpleAngle;
    const double dent = t < 1 ? kDimpleDepth * (1 - t * t) : 0;
    point = scaled(point, kRadius - dent);
  }
  return mesh;
}

template <class Value>
void put(std::vector<std::byte>& out, Value value) {
  const auto bytes = std::bit_cast<std::array<std::byte, sizeof(Value)>>(value);
  out.insert(out.end(), bytes.begin(), bytes.end());
}

}  // namespace

const char* word(CouponKind kind) {
  switch (kind) {
    case CouponKind::kSlots:
      return "slots";
    case CouponKind::kWalls:
      return "walls";
    case CouponKind::kFull:
      return "full";
    case CouponKind::kGolfBall:
      break;
  }
  return "golfball";
}

std::vector<std::string> coupon_kinds() {
  std::vector<std::string> words;
  for (const CouponKind kind : kCouponKinds) words.emplace_back(word(kind));
  return words;
}

std::optional<CouponKind> coupon_kind(const std::string& text) {
  for (const CouponKind kind : kCouponKinds) {
    if (text == word(kind)) return kind;
  }
  return std::nullopt;
}

Mesh coupon(CouponKind kind) {
  switch (kind) {
    case CouponKind::kSlots:
      return slots();
    case CouponKind::kWalls:
      return walls();
    case CouponKind::kFull:
      return full_coupon();
    case CouponKind::kGolfBall:
      break;
  }
  return golf_ball();
}

void write_stl(const Mesh& mesh, const std::string& path) {
  static_assert(std::endian::native == std::endian::little, "STL is little-endian");
  std::vector<std::byte> file(80, std::byte{' '});
  file.reserve(84 + 50 * mesh.triangles.size());
  put(file, static_cast<std::uint32_t>(mesh.triangles.size()));
  for (const Triangle& triangle : mesh.triangles) {
    for (int i = 0; i < 3; ++i) put(file, 0.0F);  // readers work the normal out for themselves
    for (const int corner : triangle) {
      for (const double value : mesh.points[static_cast<std::size_t>(corner)]) {
        put(file, static_cast<float>(value));
      }
    }
    put(file, std::uint16_t{0});
  }
  write_whole_file(path, file);
}

}  // namespace binderjet
