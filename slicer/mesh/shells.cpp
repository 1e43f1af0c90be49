// SPDX-License-Identifier: GPL-3.0-or-later
// Union-find over triangles, with one bit that says whether two of them run against each other.
#include "slicer/mesh/shells.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <numeric>
#include <utility>

#include "slicer/mesh/boundary.h"

namespace binderjet {
namespace {

class UnionFind {
 public:
  explicit UnionFind(std::size_t size) : parent_(size), turned_(size, 0) {
    std::iota(parent_.begin(), parent_.end(), 0);
  }

  // The root, and whether `item` is turned against it.
  std::pair<int, bool> find(int item) {
    int root = item;
    bool turned = false;
    while (parent_[at(root)] != root) {
      turned ^= turned_[at(root)] != 0;
      root = parent_[at(root)];
    }
    // Shortens the way for the next one.
    bool rest = turned;
    while (parent_[at(item)] != root && item != root) {
      const int next = parent_[at(item)];
      const bool step = turned_[at(item)] != 0;
      parent_[at(item)] = root;
      turned_[at(item)] = rest ? 1 : 0;
      rest ^= step;
      item = next;
    }
    return {root, turned};
  }

  // If the two are already joined the other way round (a Moebius strip), that stays.
  void join(int a, int b, bool turned) {
    const auto [root_a, turned_a] = find(a);
    const auto [root_b, turned_b] = find(b);
    if (root_a == root_b) return;
    const int low = std::min(root_a, root_b);
    const int high = std::max(root_a, root_b);
    parent_[at(high)] = low;
    turned_[at(high)] = turned ^ turned_a ^ turned_b ? 1 : 0;
  }

  Shells shells(std::size_t count, const std::vector<int>& of_triangle) {
    Shells result;
    std::vector<int> number(parent_.size(), -1);
    result.of_triangle.resize(count);
    for (std::size_t t = 0; t < count; ++t) {
      int& shell =
          number[at(find(of_triangle.empty() ? static_cast<int>(t) : of_triangle[t]).first)];
      if (shell < 0) shell = result.count++;
      result.of_triangle[t] = shell;
    }
    return result;
  }

 private:
  static std::size_t at(int index) { return static_cast<std::size_t>(index); }

  std::vector<int> parent_;
  std::vector<std::uint8_t> turned_;
};

struct Half {
  int high;
  int triangle;
  bool down;  // runs from the larger point to the smaller one

  friend bool operator<(const Half& a, const Half& b) {
    return std::pair(a.high, a.triangle) < std::pair(b.high, b.triangle);
  }
};

// Joins the triangles of every edge that has exactly two.
UnionFind join_over_edges(const Mesh& mesh) {
  std::vector<std::int64_t> begin(mesh.points.size() + 1, 0);
  const auto each = [&](const auto& visit) {
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      for (std::size_t c = 0; c < 3; ++c) {
        const int from = mesh.triangles[t][c];
        const int to = mesh.triangles[t][(c + 1) % 3];
        if (from != to) visit(static_cast<int>(t), from, to);
      }
    }
  };
  each([&](int, int from, int to) { ++begin[static_cast<std::size_t>(std::min(from, to))]; });
  std::int64_t sum = 0;
  for (std::int64_t& count : begin) count = sum += count;
  std::vector<Half> halves(static_cast<std::size_t>(sum));
  each([&](int triangle, int from, int to) {
    const auto place = --begin[static_cast<std::size_t>(std::min(from, to))];
    halves[static_cast<std::size_t>(place)] = {std::max(from, to), triangle, from > to};
  });
  UnionFind result(mesh.triangles.size());
  for (std::size_t low = 0; low + 1 < begin.size(); ++low) {
    const auto first = halves.begin() + begin[low];
    const auto last = halves.begin() + begin[low + 1];
    std::sort(first, last);
    for (auto half = first; half != last;) {
      const auto end =
          std::find_if(half, last, [&](const Half& h) { return h.high != half->high; });
      if (end - half == 2) {
        result.join(half->triangle, (half + 1)->triangle, half->down == (half + 1)->down);
      }
      half = end;
    }
  }
  return result;
}

void turn(Triangle& triangle) { std::swap(triangle[1], triangle[2]); }

constexpr std::size_t kMaxVisits = 50'000'000;  // triangles asked; about two seconds

Box box_of(const std::vector<Point>& points, const std::vector<Triangle>& triangles) {
  Box box;
  for (const Triangle& t : triangles) {
    for (const int corner : t) {
      const Point& p = points[static_cast<std::size_t>(corner)];
      for (std::size_t i = 0; i < 3; ++i) {
        box.min[i] = std::min(box.min[i], p[i]);
        box.max[i] = std::max(box.max[i], p[i]);
      }
    }
  }
  return box;
}

bool is_inside(const Box& a, const Box& b) {
  bool inside = true;
  for (std::size_t i = 0; i < 3; ++i) inside &= a.min[i] >= b.min[i] && a.max[i] <= b.max[i];
  return inside;
}

// The piece with only its own points, so that looking at it costs no more than it is large.
Mesh piece_alone(const std::vector<Point>& points, const std::vector<Triangle>& triangles) {
  Mesh own;
  own.triangles = triangles;
  std::vector<int> used;
  for (const Triangle& t : triangles) used.insert(used.end(), t.begin(), t.end());
  std::sort(used.begin(), used.end());
  used.erase(std::unique(used.begin(), used.end()), used.end());
  for (const int point : used) own.points.push_back(points[static_cast<std::size_t>(point)]);
  for (Triangle& t : own.triangles) {
    for (int& corner : t) {
      const auto place = std::lower_bound(used.begin(), used.end(), corner);
      corner = static_cast<int>(place - used.begin());
    }
  }
  return own;
}

// How often the triangles wind around the point: the sum of their solid angles (Van Oosterom and
// Strackee).
double winding_number(const std::vector<Point>& points, const std::vector<Triangle>& triangles,
                      const Point& point) {
  double sum = 0;
  for (const Triangle& triangle : triangles) {
    std::array<Point, 3> v{};
    std::array<double, 3> length{};
    for (std::size_t c = 0; c < 3; ++c) {
      const Point& corner = points[static_cast<std::size_t>(triangle[c])];
      for (std::size_t i = 0; i < 3; ++i) v[c][i] = corner[i] - point[i];
      length[c] = std::hypot(v[c][0], v[c][1], v[c][2]);
    }
    const auto dot = [](const Point& a, const Point& b) {
      return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    };
    const double triple = v[0][0] * (v[1][1] * v[2][2] - v[1][2] * v[2][1]) +
                          v[0][1] * (v[1][2] * v[2][0] - v[1][0] * v[2][2]) +
                          v[0][2] * (v[1][0] * v[2][1] - v[1][1] * v[2][0]);
    sum += std::atan2(triple, length[0] * length[1] * length[2] + dot(v[0], v[1]) * length[2] +
                                  dot(v[1], v[2]) * length[0] + dot(v[2], v[0]) * length[1]);
  }
  return sum / (2 * std::numbers::pi);
}

}  // namespace

Shells shells_by_points(const Mesh& mesh) {
  UnionFind points(mesh.points.size());
  std::vector<int> first;
  first.reserve(mesh.triangles.size());
  for (const Triangle& t : mesh.triangles) {
    points.join(t[0], t[1], false);
    points.join(t[0], t[2], false);
    first.push_back(t[0]);
  }
  return points.shells(mesh.triangles.size(), first);
}

Shells shells_by_edges(const Mesh& mesh) {
  return join_over_edges(mesh).shells(mesh.triangles.size(), {});
}

int orient_triangles(Mesh& mesh) {
  UnionFind pieces = join_over_edges(mesh);
  std::vector<double> kept_minus_turned(mesh.triangles.size(), 0.0);  // area, at the root
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto [root, turned] = pieces.find(static_cast<int>(t));
    const double area = triangle_area(mesh, mesh.triangles[t]);
    kept_minus_turned[static_cast<std::size_t>(root)] += turned ? -area : area;
  }
  int count = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto [root, turned] = pieces.find(static_cast<int>(t));
    if (turned != (kept_minus_turned[static_cast<std::size_t>(root)] < 0)) {
      turn(mesh.triangles[t]);
      ++count;
    }
  }
  return count;
}

int turn_shells_outward(Mesh& mesh) {
  const Shells shells = shells_by_edges(mesh);
  std::vector<std::vector<Triangle>> pieces(static_cast<std::size_t>(shells.count));
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    pieces[static_cast<std::size_t>(shells.of_triangle[t])].push_back(mesh.triangles[t]);
  }
  std::vector<Box> boxes;
  for (const auto& piece : pieces) boxes.push_back(box_of(mesh.points, piece));
  std::size_t visits = 0;
  std::vector<bool> turned(pieces.size(), false);
  int count = 0;
  for (std::size_t s = 0; s < pieces.size(); ++s) {
    const Mesh own = piece_alone(mesh.points, pieces[s]);
    if (signed_volume(own) >= 0 || !is_closed(own)) continue;
    bool is_cavity = false;
    for (std::size_t other = 0; other < pieces.size() && !is_cavity; ++other) {
      if (other == s || !is_inside(boxes[s], boxes[other])) continue;
      // In a swarm of thousands of pieces, those that cannot be asked stay as they are.
      visits += pieces[other].size();
      is_cavity = visits > kMaxVisits ||
                  std::abs(winding_number(mesh.points, pieces[other], own.points.front())) > 0.5;
    }
    turned[s] = !is_cavity;
    count += is_cavity ? 0 : 1;
  }
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (turned[static_cast<std::size_t>(shells.of_triangle[t])]) turn(mesh.triangles[t]);
  }
  return count;
}

}  // namespace binderjet
